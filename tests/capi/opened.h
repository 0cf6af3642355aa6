// tests/capi/opened.h -- opens real volumes by the C interface.
#pragma once

#include <filesystem>
#include <memory>

#include <gtest/gtest.h>

#include "stormcellar.h"

namespace stormcellar::testing {

struct FreeVolume {
    void operator()(stormcellar_volume* volume) const { stormcellar_volume_free(volume); }
};
using OpenedVolume = std::unique_ptr<stormcellar_volume, FreeVolume>;

inline OpenedVolume opened(const std::filesystem::path& file,
                           const stormcellar_read_options* options = nullptr) {
    stormcellar_volume* volume = nullptr;
    stormcellar_error error{};
    EXPECT_EQ(stormcellar_volume_open(file.c_str(), options, &volume, &error), STORMCELLAR_OK)
        << error.message;
    return OpenedVolume(volume);
}

struct FreeGrid {
    void operator()(stormcellar_grid* grid) const { stormcellar_grid_free(grid); }
};
using OwnedGrid = std::unique_ptr<stormcellar_grid, FreeGrid>;

template <class Facts>
Facts empty_facts() {
    Facts facts{};
    facts.size = sizeof facts;
    return facts;
}

inline stormcellar_volume_facts facts_of(const OpenedVolume& volume) {
    auto facts = empty_facts<stormcellar_volume_facts>();
    EXPECT_EQ(stormcellar_volume_describe(volume.get(), &facts, nullptr), STORMCELLAR_OK);
    return facts;
}

}  // namespace stormcellar::testing
