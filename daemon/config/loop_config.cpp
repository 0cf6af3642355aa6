#include "daemon/config/loop_config.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <system_error>

#include <fmt/format.h>

#include "base/printable.h"
#include "stormcellar/cache/grid_name.h"

namespace stormcellar::daemon {
namespace {

namespace fs = std::filesystem;

bool lies_within(const fs::path& path, const fs::path& directory) {
    const auto end = std::mismatch(directory.begin(), directory.end(), path.begin(), path.end());
    return end.first == directory.end();
}

void read_name(TomlTable& table, std::set<std::string>& names, LoopConfig& loop) {
    const auto name = table.text("name");
    if (!name) {
        if (!table.has("name")) table.complain("name", "must be given");
    } else if (!cache::is_domain_name(*name) || cache::is_part(*name)) {
        table.complain("name", fmt::format("\"{}\" must consist of letters, digits, - and _",
                                           printable(*name)));
    } else if (!names.insert(*name).second) {
        table.complain("name", fmt::format("\"{}\" is named twice", *name));
    } else {
        loop.name = *name;
    }
}

void read_outputs(TomlTable& table, const fs::path& directory, const std::vector<fs::path>& apart,
                  std::set<std::string>& known, LoopConfig& loop) {
    const auto outputs = table.texts("outputs");
    if (!outputs) return;
    if (outputs->empty()) table.complain("outputs", "must name at least one");
    for (const std::string& output : *outputs) {
        if (output.empty()) {
            table.complain("outputs", "must not be empty");
            continue;
        }
        const fs::path path = (directory / output).lexically_normal();
        const fs::path plain = path.has_filename() ? path : path.parent_path();
        for (const fs::path& other : apart) {
            if (other.empty() || !lies_within(plain, other)) continue;
            table.complain("outputs", fmt::format("{} is within {}", printable(path.native()),
                                                  printable(other.native())));
        }
        if (!known.insert(plain.native()).second) {
            table.complain("outputs", fmt::format("{} is named twice", printable(path.native())));
        }
        loop.outputs.push_back(path.native());
    }
}

void read_scene(TomlTable& table, const fs::path& directory, SceneFiles scenes, LoopConfig& loop) {
    const auto scene = table.text("scene");
    if (!scene) return;
    if (scene->empty()) return table.complain("scene", "must not be empty");
    loop.scene = (directory / *scene).lexically_normal();
    if (scenes == SceneFiles::as_named) return;
    std::error_code error;
    const fs::file_status found = fs::status(loop.scene, error);
    if (fs::is_regular_file(found)) return;
    table.complain("scene", fmt::format("{}: {}", printable(loop.scene.native()),
                                        error ? error.message() : "is not a file"));
}

void read_range(TomlTable& table, LoopConfig& loop) {
    if (const auto last = table.whole_number("last", {1, 1'000'000})) loop.last = *last;
    if (const auto hours = table.number("hours", {0.01, 8760})) {
        loop.seconds = static_cast<int>(std::lround(*hours * 3600));
    }
}

}  // namespace

std::vector<LoopConfig> read_loops(TomlTable& root, const fs::path& directory,
                                   const std::vector<fs::path>& apart, SceneFiles scenes) {
    std::vector<LoopConfig> loops;
    std::set<std::string> names;
    std::set<std::string> outputs;
    for (TomlTable& table : root.tables("loop")) {
        LoopConfig loop;
        read_name(table, names, loop);
        read_scene(table, directory, scenes, loop);
        if (const auto domain = table.text("domain")) {
            if (!cache::is_domain_name(*domain)) {
                table.complain("domain", fmt::format("\"{}\" is not a valid name of a domain",
                                                     printable(*domain)));
            }
            loop.domain = *domain;
        }
        read_range(table, loop);
        read_outputs(table, directory, apart, outputs, loop);
        if (!table.has("scene")) {
            for (const char* key : {"domain", "outputs"}) {
                if (!table.has(key)) table.complain(key, "must be given if no scene is named");
            }
        }
        loops.push_back(std::move(loop));
    }
    return loops;
}

std::vector<std::string> arguments_of(const LoopConfig& loop, const fs::path& cache, long parent) {
    std::vector<std::string> arguments{"loop", "--follow", "--json"};
    const auto add = [&](const char* option, std::string value) {
        arguments.emplace_back(option);
        arguments.push_back(std::move(value));
    };
    add("--cache", cache.native());
    add("--with-parent", std::to_string(parent));
    if (!loop.scene.empty()) add("--scene", loop.scene.native());
    if (!loop.domain.empty()) add("--domain", loop.domain);
    if (loop.last > 0) add("--last", std::to_string(loop.last));
    if (loop.seconds > 0) arguments.push_back(fmt::format("--from=-{}s", loop.seconds));
    for (const std::string& output : loop.outputs)
        add("--output", output);
    return arguments;
}

}  // namespace stormcellar::daemon
