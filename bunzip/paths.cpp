#include "bunzip/paths.h"

#include <algorithm>
#include <atomic>
#include <cstdlib>

#include "bunzip/targets-inl.h"
// This include must come after the choice of targets.
#include <hwy/highway.h>
#include <hwy/targets.h>

namespace stormcellar::bunzip {
namespace {

constexpr int not_chosen = -1;
std::atomic<int> chosen_path = not_chosen;

Path path_of_environment() {
    const char* const name = std::getenv("STORMCELLAR_BUNZIP");
    const auto path = name != nullptr ? path_named(name) : std::nullopt;
    return path && is_available(*path) ? *path : fastest_path();
}

}  // namespace

std::string_view name_of(Path path) {
    constexpr std::array<std::string_view, all_paths.size()> names = {"libbz2", "plain", "avx2",
                                                                      "avx512"};
    return names[static_cast<std::size_t>(path)];
}

std::optional<Path> path_named(std::string_view name) {
    const auto found = std::find_if(all_paths.begin(), all_paths.end(),
                                    [name](Path path) { return name_of(path) == name; });
    if (found == all_paths.end()) return std::nullopt;
    return *found;
}

bool is_available(Path path) {
    switch (path) {
        case Path::libbz2:
        case Path::plain:
            return true;
        case Path::avx2:
            return (HWY_TARGETS & hwy::SupportedTargets() & HWY_AVX2) != 0;
        case Path::avx512:
            return (HWY_TARGETS & hwy::SupportedTargets() & HWY_AVX3_DL) != 0;
    }
    return false;
}

Path fastest_path() {
    for (const Path path : {Path::avx512, Path::avx2}) {
        if (is_available(path)) return path;
    }
    return Path::plain;
}

Path usual_path() {
    const int chosen = chosen_path.load(std::memory_order_relaxed);
    if (chosen != not_chosen) return static_cast<Path>(chosen);
    static const Path path = path_of_environment();
    return path;
}

bool set_usual_path(Path path) {
    if (!is_available(path)) return false;
    chosen_path.store(static_cast<int>(path), std::memory_order_relaxed);
    return true;
}

}  // namespace stormcellar::bunzip
