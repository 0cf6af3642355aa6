#include "web/config/served_loops.h"

#include <optional>
#include <system_error>

#include "base/toml_file.h"

namespace stormcellar::web {
namespace {

namespace fs = std::filesystem;

fs::path directory_of(const fs::path& file) {
    std::error_code ignored;
    return fs::absolute(file, ignored).parent_path();
}

std::vector<fs::path> files_in(TomlTable& table, const fs::path& directory) {
    std::vector<fs::path> files;
    for (const std::string& output : table.texts("outputs").value_or(std::vector<std::string>{})) {
        const fs::path path = (directory / output).lexically_normal();
        if (!output.empty() && path.has_filename()) files.push_back(path);
    }
    return files;
}

std::vector<fs::path> files_of_scene(const fs::path& scene) {
    auto toml = TomlFile::open(scene);
    if (!toml) return {};
    TomlTable loop = toml->root().section("loop");
    return files_in(loop, directory_of(scene));
}

}  // namespace

std::vector<ServedLoop> read_served_loops(const fs::path& file) {
    std::vector<ServedLoop> loops;
    auto toml = TomlFile::open(file);
    if (!toml) return loops;
    const fs::path directory = directory_of(file);
    for (TomlTable& table : toml->root().tables("loop")) {
        const auto name = table.text("name");
        if (!name || name->empty()) continue;
        ServedLoop loop{*name, files_in(table, directory)};
        const auto scene = table.text("scene");
        if (loop.files.empty() && scene) loop.files = files_of_scene(directory / *scene);
        loops.push_back(std::move(loop));
    }
    return loops;
}

}  // namespace stormcellar::web
