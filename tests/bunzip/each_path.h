// tests/bunzip/each_path.h -- lists the paths that this machine supports, and names the tests of
// each path.
#pragma once

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "bunzip/paths.h"

namespace stormcellar::bunzip {

inline std::vector<Path> available_paths() {
    std::vector<Path> paths;
    for (const Path path : all_paths) {
        if (is_available(path)) paths.push_back(path);
    }
    return paths;
}

inline std::string test_name(const ::testing::TestParamInfo<Path>& info) {
    return std::string{name_of(info.param)};
}

// Returns the paths that have kernels: all available paths except libbz2.
inline std::vector<Path> available_kernels() {
    std::vector<Path> paths = available_paths();
    paths.erase(paths.begin());
    return paths;
}

}  // namespace stormcellar::bunzip
