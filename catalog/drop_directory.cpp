#include "catalog/drop_directory.h"

#include <span>
#include <string>
#include <string_view>

#include "base/beneath.h"
#include "stormcellar/base/file_system.h"

namespace stormcellar::catalog {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view file_name = "drop-directory";
constexpr std::uint64_t most_bytes = 8192;  // twice the longest path

}  // namespace

Status write_drop_directory(const fs::path& catalog, const fs::path& drop) {
    const auto known = read_drop_directory(catalog);
    if (known && *known == drop) return {};
    const std::string text = drop.native() + "\n";
    return write_file_atomically(real_file_system(), catalog / file_name,
                                 std::as_bytes(std::span(text)));
}

Result<fs::path> read_drop_directory(const fs::path& catalog) {
    const fs::path file = catalog / file_name;
    const auto bytes = read_beneath({}, file, most_bytes);
    if (!bytes) return pass_on(bytes);
    std::string text(reinterpret_cast<const char*>(bytes->data()), bytes->size());
    if (text.ends_with('\n')) text.pop_back();
    const bool is_path = text.starts_with('/') && text.find('\0') == std::string::npos;
    if (!is_path)
        return fail(ErrorCode::corrupt, "{}: does not hold an absolute path", file.native());
    return fs::path{std::move(text)};
}

}  // namespace stormcellar::catalog
