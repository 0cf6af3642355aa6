// tests/pipeline/living_house.h -- a catalog, a cache and an Ingestor that makes living grids
// (grids of growing volumes), and volumes that come piece by piece.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "pipeline/ingest/ingest.h"
#include "stormcellar/base/file_system.h"
#include "stormcellar/cache/grid_file.h"
#include "stormcellar/cache/store.h"
#include "stormcellar/catalog/catalog.h"
#include "synth/replay_pieces.h"
#include "tests/pipeline/small_house.h"
#include "tests/testing/file_bytes.h"

namespace stormcellar::pipeline {

inline constexpr const char* busy = "volumes/KLOT20220317_000842_V06";
// The modification time of all files, so that grids made at different times are the same to the
// byte.
inline constexpr std::int64_t file_time_s = 1'650'000'000;

inline std::vector<std::byte> real_bytes(const std::string& name) {
    return *read_file(testing::real_file(name));
}

using testing::append_to;

inline void date(const fs::path& path) {
    const std::array<timespec, 2> times = {timespec{file_time_s, 0}, timespec{file_time_s, 0}};
    ASSERT_EQ(::utimensat(AT_FDCWD, path.c_str(), times.data(), 0), 0);
}

// Returns the volume with all times later by `by`.
inline level2::Volume later(level2::Volume volume, std::chrono::milliseconds by) {
    const UtcTime start = volume.header->time() + by;
    const NexradTime named = nexrad_from_time(start);
    volume.header->date = named.day;
    volume.header->ms = named.milliseconds;
    for (level2::Sweep& sweep : volume.sweeps) {
        for (level2::Radial& radial : sweep.radials)
            radial.time += by;
    }
    return volume;
}

struct House {
    explicit House(const fs::path& where, bool living, std::function<Load()> load = {},
                   std::vector<level2::Moment> moments = {level2::Moment::ref},
                   double quality = 0) {
        catalog.emplace(*catalog::CatalogWriter::open(where / "catalog"));
        store.emplace(*cache::StoreWriter::open(real_file_system(), where / "cache", true));
        IngestOptions options = small_grid();
        options.moments = std::move(moments);
        options.derived.quality = quality;
        if (living) {
            options.living.scratch = where;
            options.living.load = std::move(load);
            options.living.chunk_grace = std::chrono::seconds{0};
        }
        ingestor.emplace(*catalog, *store, options);
    }
    std::vector<cache::StoreEntry> grids(const std::string& domain,
                                         level2::Moment moment = level2::Moment::ref) const {
        return *store->list(domain, moment, std::nullopt, std::nullopt);
    }
    std::optional<catalog::CatalogWriter> catalog;
    std::optional<cache::StoreWriter> store;
    std::optional<Ingestor> ingestor;
};

class Living : public ::testing::Test {
  protected:
    void SetUp() override { STORMCELLAR_NEED_DATA(); }
    // Appends the records one by one, and ingests the file after each.
    std::vector<IngestOutcome> grow(House& house, const fs::path& path,
                                    std::span<const std::byte> bytes, std::size_t most = 1000) {
        std::vector<IngestOutcome> outcomes;
        std::size_t from = 0;
        for (const std::size_t end : synth::piece_ends(bytes)) {
            if (outcomes.size() == most) break;
            append_to(path, bytes.subspan(from, end - from));
            from = end;
            date(path);
            auto outcome = house.ingestor->ingest(path, false);
            EXPECT_TRUE(outcome) << outcome.error().message;
            if (outcome) outcomes.push_back(std::move(*outcome));
        }
        return outcomes;
    }
    testing::TemporaryDirectory directory_;
    House house_{directory_ / "living", true};
};

// Tests a volume that is cut into one file for each record, as LDM delivers it.
class LivingChunks : public Living {
  protected:
    void SetUp() override {
        Living::SetUp();
        bytes_ = real_bytes(busy);
        fs::create_directories(drop_);
        const std::vector<std::size_t> ends = synth::piece_ends(bytes_);
        for (std::size_t i = 0; i < ends.size(); ++i) {
            const char kind = i == 0 ? 'S' : i + 1 == ends.size() ? 'E' : 'I';
            names_.push_back(fmt::format("20220317-000842-{:03}-{}", i + 1, kind));
            const std::size_t from = i == 0 ? 0 : ends[i - 1];
            parts_.push_back(std::span{bytes_}.subspan(from, ends[i] - from));
        }
        const fs::path file = directory_ / "KLOT20220317_000842_V06";
        append_to(file, bytes_);
        ASSERT_EQ(whole_.ingestor->ingest(file, false)->result(), IngestResult::gridded);
    }
    // Begins again, as after a restart, with this limit of sweeps on disk.
    void begin_again_with(std::uint64_t shelf_bytes) {
        house_.ingestor.reset();
        IngestOptions options = small_grid();
        options.living.scratch = directory_ / "living";
        options.living.shelf_bytes = shelf_bytes;
        house_.ingestor.emplace(*house_.catalog, *house_.store, options);
    }
    IngestOutcome take(House& house, std::size_t i, bool finish_as_is = false) {
        const fs::path path = drop_ / names_[i];
        if (!fs::exists(path)) {
            append_to(path, parts_[i]);
            const std::array<timespec, 2> times = {timespec{file_time_s + came_, 0},
                                                   timespec{file_time_s + came_, 0}};
            EXPECT_EQ(::utimensat(AT_FDCWD, path.c_str(), times.data(), 0), 0);
            ++came_;
        }
        auto outcome = house.ingestor->ingest(path, finish_as_is);
        EXPECT_TRUE(outcome) << outcome.error().message;
        return outcome ? *outcome : IngestOutcome{};
    }
    void expect_same_cells(const House& house) {
        ASSERT_EQ(house.grids("KLOT").size(), 1U);
        const auto a = cache::GridFile::open(house.grids("KLOT")[0].path);
        const auto b = cache::GridFile::open(whole_.grids("KLOT")[0].path);
        ASSERT_TRUE(a && b);
        EXPECT_FALSE(a->description().provenance.partial);
        EXPECT_TRUE(std::ranges::equal(a->view().codes, b->view().codes));
        EXPECT_TRUE(std::ranges::equal(a->view().states, b->view().states));
        EXPECT_EQ(a->description().provenance.sweeps, b->description().provenance.sweeps);
        EXPECT_EQ(a->description().time, b->description().time);
    }
    void expect_one_volume(House& house) {
        const auto volumes = house.catalog->list("KLOT", {});
        ASSERT_EQ(volumes->size(), 1U);
        EXPECT_EQ(volumes->at(0).path.filename(), names_[0]);
        EXPECT_EQ(volumes->at(0).state, catalog::FileState::complete);
        EXPECT_EQ(volumes->at(0).generation, 0);
        const auto rows = house.catalog->list("KLOT", {std::nullopt, std::nullopt, true});
        EXPECT_EQ(rows->size(), names_.size());
    }
    void expect_the_whole_volume_once() {
        expect_same_cells(house_);
        expect_one_volume(house_);
    }
    fs::path drop_ = directory_ / "drop/KLOT/494";
    std::int64_t came_ = 0;  // each file comes a second after the previous one
    House whole_{directory_ / "whole", false};
    std::vector<std::byte> bytes_;
    std::vector<std::string> names_;
    std::vector<std::span<const std::byte>> parts_;
};

}  // namespace stormcellar::pipeline
