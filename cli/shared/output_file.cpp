#include "cli/shared/output_file.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <system_error>
#include <utility>

#include <fmt/ranges.h>
#include <unistd.h>

#include "stormcellar/base/file_system.h"

namespace stormcellar::cli {
namespace {

namespace fs = std::filesystem;

Status to_stdout(std::span<const std::byte> bytes) {
    std::fflush(stdout);
    while (!bytes.empty()) {
        const ssize_t done = ::write(STDOUT_FILENO, bytes.data(), bytes.size());
        if (done < 0 && errno == EINTR) continue;
        if (done < 0) {
            return fail(ErrorCode::io, "standard output: {}",
                        std::system_category().message(errno));
        }
        bytes = bytes.subspan(static_cast<std::size_t>(done));
    }
    return {};
}

}  // namespace

bool is_stdout(std::string_view output) {
    return output == "-";
}

Status check_output_file(const std::string& output, const std::vector<std::string_view>& endings,
                         std::string_view what, bool json) {
    if (is_stdout(output)) {
        if (!json) return {};
        return fail(ErrorCode::bad_argument,
                    "-o - and --json would both write to standard output; name a file");
    }
    if (Status target = check_target(output); !target) return target;
    const auto fits = [&](std::string_view ending) { return output.ends_with(ending); };
    if (std::none_of(endings.begin(), endings.end(), fits)) {
        return fail(ErrorCode::bad_argument,
                    "{}: {}: the name must end in {}, or be - for standard output", output, what,
                    fmt::join(endings, " or "));
    }
    return {};
}

Result<OutputFile> OutputFile::open(const std::string& output, std::string_view ending) {
    if (!is_stdout(output)) return OutputFile(output, std::nullopt);
    auto scratch = ScratchDirectory::make();
    if (!scratch) return pass_on(scratch);
    fs::path path = scratch->path() / fmt::format("output{}", ending);
    return OutputFile(std::move(path), std::move(*scratch));
}

Status OutputFile::finish() {
    if (!scratch_) return {};
    const auto bytes = read_file(path_);
    if (!bytes) return pass_on(bytes);
    return to_stdout(*bytes);
}

Status write_output(const std::string& output, std::span<const std::byte> bytes) {
    if (is_stdout(output)) return to_stdout(bytes);
    return write_file_atomically(real_file_system(), output, bytes);
}

}  // namespace stormcellar::cli
