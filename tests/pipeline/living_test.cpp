// Volumes that grow record by record: what stands in the cache meanwhile, and that nothing of it is
// left in the end.
#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <fstream>
#include <thread>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include "base/checksum.h"
#include "base/file_system.h"
#include "cache/grid_file.h"
#include "grid/column_geometry.h"
#include "grid/gridder.h"
#include "level2/decode.h"
#include "level2/encode.h"
#include "level2/volume_difference.h"
#include "pipeline/chunk_volumes.h"
#include "pipeline/ingest.h"
#include "pipeline/living_files.h"
#include "pipeline/sweep_shelf.h"
#include "synth/replay_pieces.h"
#include "tests/testing/data.h"
#include "tests/testing/temporary_directory.h"

namespace stormcellar::pipeline {
namespace {

namespace fs = std::filesystem;

constexpr const char* busy = "volumes/KLOT20220317_000842_V06";
// A day number for all files, so that grids made at different times are the same to the byte.
constexpr std::int64_t file_time_s = 1'650'000'000;

std::vector<std::byte> real_bytes(const std::string& name) {
    return *read_file(*testing::data_directory() / name);
}

void append_to(const fs::path& path, std::span<const std::byte> bytes) {
    std::ofstream(path, std::ios::binary | std::ios::app)
        .write(reinterpret_cast<const char*>(bytes.data()),
               static_cast<std::streamsize>(bytes.size()));
}

void date(const fs::path& path) {
    const std::array<timespec, 2> times = {timespec{file_time_s, 0}, timespec{file_time_s, 0}};
    ASSERT_EQ(::utimensat(AT_FDCWD, path.c_str(), times.data(), 0), 0);
}

// The same volume as it would have been so much later.
level2::Volume later(level2::Volume volume, std::chrono::milliseconds by) {
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
    explicit House(const fs::path& where, bool living, std::function<bool()> has_time = {}) {
        catalog.emplace(*catalog::Catalog::open_for_writing(where / "catalog"));
        store.emplace(*cache::Store::open_for_writing(real_file_system(), where / "cache", true));
        IngestOptions options;
        options.spacing_m = 4000;
        options.nx = options.ny = 115;
        if (living) {
            options.living.scratch = where;
            options.living.has_time = std::move(has_time);
            options.living.chunk_grace = std::chrono::seconds{0};
        }
        ingestor.emplace(*catalog, *store, options);
    }
    std::vector<cache::StoreEntry> grids(const std::string& domain) const {
        return *store->list(domain, level2::Moment::ref, std::nullopt, std::nullopt);
    }
    std::optional<catalog::Catalog> catalog;
    std::optional<cache::Store> store;
    std::optional<Ingestor> ingestor;
};

class Living : public ::testing::Test {
  protected:
    void SetUp() override { STORMCELLAR_NEED_DATA(); }
    // Appends each record and has it taken in.
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

TEST_F(Living, EverySweepIsShownAndTheEndIsThatOfTheWholeFile) {
    const std::vector<std::byte> bytes = real_bytes(busy);
    const fs::path path = directory_ / "KLOT20220317_000842_V06";
    const std::vector<IngestOutcome> outcomes = grow(house_, path, bytes);
    ASSERT_GT(outcomes.size(), 20U);
    std::size_t shown = 0;
    for (std::size_t i = 0; i + 1 < outcomes.size(); ++i) {
        EXPECT_EQ(outcomes[i].result, IngestResult::incomplete) << i;
        shown += outcomes[i].living.size();
    }
    EXPECT_EQ(outcomes.back().result, IngestResult::gridded);
    const level2::Volume volume = level2::decode(bytes)->volume;
    EXPECT_EQ(shown, volume.sweeps.size() - 1);  // the last one ends the volume

    // Another house takes the complete file.
    House whole(directory_ / "whole", false);
    ASSERT_EQ(whole.ingestor->ingest(path, false)->result, IngestResult::gridded);
    ASSERT_EQ(house_.grids("KLOT").size(), 1U);
    ASSERT_EQ(whole.grids("KLOT").size(), 1U);
    EXPECT_EQ(*read_file(house_.grids("KLOT")[0].path), *read_file(whole.grids("KLOT")[0].path));
    const auto rows = house_.catalog->list("KLOT", {std::nullopt, std::nullopt, true});
    const auto same = whole.catalog->list("KLOT", {std::nullopt, std::nullopt, true});
    ASSERT_EQ(rows->size(), 1U);
    EXPECT_EQ(rows->at(0).state, same->at(0).state);
    EXPECT_EQ(rows->at(0).volume.sweep_count, same->at(0).volume.sweep_count);
    EXPECT_EQ(rows->at(0).volume.radial_count, same->at(0).volume.radial_count);
}

// By hand: the last volume's sweeps in front, and the new ones behind them.
TEST_F(Living, TheLastVolumeStandsUntilItsSweepsComeAgain) {
    const std::vector<std::byte> first_bytes = real_bytes(busy);
    const fs::path first_path = directory_ / "KLOT20220317_000842_V06";
    ASSERT_EQ(grow(house_, first_path, first_bytes).back().result, IngestResult::gridded);
    const level2::Volume first = level2::decode(first_bytes)->volume;
    const level2::Volume second = later(first, std::chrono::minutes{12});
    const auto encoded = level2::encode(second);
    ASSERT_TRUE(encoded) << encoded.error().message;
    const std::vector<std::byte> second_bytes = encoded->joined();
    const auto outcomes = grow(house_, directory_ / "KLOT20220317_002042_V06", second_bytes, 30);
    std::size_t shown = 0;
    for (const IngestOutcome& outcome : outcomes)
        shown += outcome.living.size();
    ASSERT_GT(shown, 1U);
    const auto grids = house_.grids("KLOT");
    ASSERT_EQ(grids.size(), 2U);
    const auto file = cache::GridFile::open(grids.back().path);
    ASSERT_TRUE(file) << file.error().message;
    const cache::GridDescription& made = file->description();
    EXPECT_TRUE(made.provenance.partial);
    ASSERT_EQ(made.provenance.notes.size(), 1U);
    EXPECT_TRUE(made.provenance.notes[0].starts_with("living: ")) << made.provenance.notes[0];
    // Each elevation once, the low ones of the new volume and the high ones of the last.
    const UtcTime second_start = second.header->time();
    std::size_t fresh = 0;
    for (std::size_t i = 0; i < made.provenance.sweeps.size(); ++i) {
        const grid::SweepTime& sweep = made.provenance.sweeps[i];
        const bool is_new = sweep.start >= second_start;
        fresh += is_new ? 1 : 0;
        if (i > 0 && is_new) {
            EXPECT_GE(made.provenance.sweeps[i - 1].start, second_start)
                << "an old sweep at " << sweep.elevation_deg << " degrees below a new one";
        }
    }
    EXPECT_GE(fresh, 1U);
    EXPECT_LT(fresh, made.provenance.sweeps.size());

    level2::Volume by_hand = second;
    by_hand.sweeps.clear();
    std::vector<level2::Sweep> news(second.sweeps.begin(),
                                    second.sweeps.begin() + static_cast<std::ptrdiff_t>(shown));
    for (const level2::Sweep& old : first.sweeps) {
        const bool again = std::any_of(news.begin(), news.end(), [&](const level2::Sweep& s) {
            return s.find(level2::Moment::ref) != nullptr &&
                   std::abs(s.mean_elevation_deg() - old.mean_elevation_deg()) < 0.2;
        });
        if (!again && old.find(level2::Moment::ref) != nullptr) by_hand.sweeps.push_back(old);
    }
    by_hand.sweeps.insert(by_hand.sweeps.end(), news.begin(), news.end());
    const auto geometry = grid::make_column_geometry(made.sites.front(), made.spec);
    ASSERT_TRUE(geometry);
    const auto expected = grid::make_grid(by_hand, made.sites.front(), **geometry, {});
    ASSERT_TRUE(expected);
    const grid::BrickView view = file->view();
    std::size_t differ = 0;
    for (int z = 0; z < made.spec.nz(); ++z) {
        for (int y = 0; y < made.spec.ny; ++y) {
            for (int x = 0; x < made.spec.nx; ++x) {
                const auto at = expected->spec.index(x, y, z);
                differ += view.status(x, y, z) != expected->status[at] ? 1 : 0;
            }
        }
    }
    EXPECT_EQ(differ, 0U);
}

TEST_F(Living, WithoutTimeLowSweepsAreShownAndTheOthersTogetherLater) {
    bool has_time = false;
    House house(directory_ / "hurried", true, [&] { return has_time; });
    const std::vector<std::byte> bytes = real_bytes(busy);
    const fs::path path = directory_ / "KLOT20220317_000842_V06";
    const auto outcomes = grow(house, path, bytes, 40);
    const auto shown = [](const IngestOutcome& outcome) { return !outcome.living.empty(); };
    const auto left_out = [](const IngestOutcome& outcome) { return outcome.living_left_out; };
    // Its cuts: 0.5 degrees twice, higher ones, and 0.5 again half-way (SAILS).
    EXPECT_GT(std::count_if(outcomes.begin(), outcomes.end(), shown), 0);
    EXPECT_GT(std::count_if(outcomes.begin(), outcomes.end(), left_out), 0);
    ASSERT_TRUE(outcomes.back().living_left_out) << "a high sweep was the last";
    EXPECT_TRUE(outcomes.back().living.empty());
    has_time = true;
    append_to(path, std::span{bytes}.subspan(fs::file_size(path), 1000));
    const auto outcome = house.ingestor->ingest(path, false);
    ASSERT_TRUE(outcome);
    EXPECT_EQ(outcome->living.size(), 1U);
    EXPECT_FALSE(outcome->living_left_out);
    EXPECT_EQ(house.grids("KLOT").size(), 1U);
}

TEST_F(Living, AFileThatIsRewrittenMeanwhileIsReadAsItIs) {
    const std::vector<std::byte> bytes = real_bytes(busy);
    const std::vector<std::byte> other = real_bytes("volumes/KLBB20160601_150025_V06");
    const fs::path path = directory_ / "KLOT20220317_000842_V06";
    grow(house_, path, bytes, 20);
    const std::size_t size = fs::file_size(path);
    // In place, so that it is the same file and longer than it was.
    ASSERT_GT(other.size(), size);
    std::fstream(path, std::ios::binary | std::ios::in | std::ios::out)
        .write(reinterpret_cast<const char*>(other.data()),
               static_cast<std::streamsize>(other.size()));
    ASSERT_EQ(fs::file_size(path), other.size());
    const auto outcome = house_.ingestor->ingest(path, true);
    ASSERT_TRUE(outcome);
    EXPECT_EQ(outcome->result, IngestResult::gridded);
    EXPECT_EQ(outcome->station, "KLBB");
    EXPECT_FALSE(outcome->partial);
}

TEST_F(Living, AVolumeThatStopsIsWhatItIsWhenReadWhole) {
    const std::vector<std::byte> bytes = real_bytes(busy);
    const fs::path path = directory_ / "KLOT20220317_000842_V06";
    grow(house_, path, bytes, 25);
    append_to(path, std::span{bytes}.subspan(fs::file_size(path), 777));
    date(path);
    const auto outcome = house_.ingestor->ingest(path, true);
    ASSERT_TRUE(outcome);
    EXPECT_EQ(outcome->result, IngestResult::gridded);
    EXPECT_TRUE(outcome->partial);
    House whole(directory_ / "whole", false);
    ASSERT_EQ(whole.ingestor->ingest(path, true)->result, IngestResult::gridded);
    EXPECT_EQ(*read_file(house_.grids("KLOT")[0].path), *read_file(whole.grids("KLOT")[0].path));
}

// Cuts a file as LDM hands it on, one file a record; gives the paths in their order.
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
        // What the whole file gives.
        const fs::path file = directory_ / "KLOT20220317_000842_V06";
        append_to(file, bytes_);
        ASSERT_EQ(whole_.ingestor->ingest(file, false)->result, IngestResult::gridded);
    }
    IngestOutcome take(House& house, std::size_t i, bool finish_partial = false) {
        const fs::path path = drop_ / names_[i];
        if (!fs::exists(path)) {
            append_to(path, parts_[i]);
            const std::array<timespec, 2> times = {timespec{file_time_s + came_, 0},
                                                   timespec{file_time_s + came_, 0}};
            EXPECT_EQ(::utimensat(AT_FDCWD, path.c_str(), times.data(), 0), 0);
            ++came_;
        }
        auto outcome = house.ingestor->ingest(path, finish_partial);
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
    fs::path drop_ = directory_ / "drop/KLOT/494";
    std::int64_t came_ = 0;  // each a second after the one before
    House whole_{directory_ / "whole", false};
    std::vector<std::byte> bytes_;
    std::vector<std::string> names_;
    std::vector<std::span<const std::byte>> parts_;
};

TEST_F(LivingChunks, MakeTheVolumeThatTheWholeFileHolds) {
    std::size_t shown = 0;
    for (std::size_t i = 0; i + 1 < names_.size(); ++i) {
        const IngestOutcome outcome = take(house_, i);
        EXPECT_EQ(outcome.result, IngestResult::incomplete) << i;
        shown += outcome.living.size();
    }
    EXPECT_GT(shown, 5U);
    EXPECT_EQ(take(house_, 0, true).result, IngestResult::registered) << "not in the name of all";
    EXPECT_EQ(take(house_, names_.size() - 2, true).result, IngestResult::incomplete);
    const IngestOutcome last = take(house_, names_.size() - 1);
    EXPECT_EQ(last.result, IngestResult::gridded);
    EXPECT_EQ(last.station, "KLOT");
    expect_same_cells(house_);
    expect_one_volume(house_);
    for (std::size_t i = 0; i < names_.size(); ++i)
        EXPECT_EQ(take(house_, i, true).result, IngestResult::unchanged) << i;
}

TEST_F(LivingChunks, MayComeInAnyOrder) {
    std::vector<std::size_t> order(names_.size());
    for (std::size_t i = 0; i < order.size(); ++i)
        order[i] = (i * 17 + 5) % order.size();  // 55 has no factor 17
    for (std::size_t i = 0; i + 1 < order.size(); ++i)
        EXPECT_NE(take(house_, order[i]).result, IngestResult::gridded) << order[i];
    EXPECT_EQ(take(house_, order.back()).result, IngestResult::gridded);
    expect_same_cells(house_);
    expect_one_volume(house_);
}

TEST_F(LivingChunks, AreTakenUpByAnotherProcess) {
    for (std::size_t i = 0; i < 30; ++i)
        take(house_, i);
    house_.ingestor.reset();
    IngestOptions options;
    options.spacing_m = 4000;
    options.nx = options.ny = 115;
    options.living.scratch = directory_ / "living";
    house_.ingestor.emplace(*house_.catalog, *house_.store, options);
    for (std::size_t i = 30; i < names_.size(); ++i)
        take(house_, i);
    expect_same_cells(house_);
    expect_one_volume(house_);
}

TEST_F(LivingChunks, OneThatIsLostLeavesAPartialVolumeUntilItComes) {
    for (std::size_t i = 0; i < names_.size(); ++i) {
        if (i == 20) continue;
        EXPECT_NE(take(house_, i).result, IngestResult::gridded);
    }
    const IngestOutcome partial = take(house_, names_.size() - 1, true);
    EXPECT_EQ(partial.result, IngestResult::gridded);
    EXPECT_TRUE(partial.partial);
    EXPECT_NE(partial.reason.find("missing chunks: 21"), std::string::npos) << partial.reason;
    EXPECT_EQ(take(house_, 20).result, IngestResult::gridded);
    expect_same_cells(house_);
    expect_one_volume(house_);
}

TEST_F(LivingChunks, ALateOneThatDoesNotMakeItWholeIsGriddedToo) {
    const auto notes = [&] {
        return cache::GridFile::open(house_.grids("KLOT").at(0).path)
            ->description()
            .provenance.notes;
    };
    for (std::size_t i = 0; i < names_.size(); ++i) {
        if (i != 20 && i != 30) take(house_, i);
    }
    ASSERT_EQ(take(house_, names_.size() - 1, true).result, IngestResult::gridded);
    EXPECT_TRUE(notes().empty()) << "the end of it, not a living grid";
    EXPECT_EQ(take(house_, 20).result, IngestResult::incomplete) << "it waits in the name of all";
    EXPECT_TRUE(notes().empty()) << "a living grid is no better than an ended one";
    const IngestOutcome again = take(house_, 20, true);
    EXPECT_EQ(again.result, IngestResult::gridded);
    EXPECT_NE(again.reason.find("missing chunks: 31"), std::string::npos) << again.reason;
    const auto rows = house_.catalog->list("KLOT", {std::nullopt, std::nullopt, true});
    for (const auto& row : *rows)
        EXPECT_NE(row.state, catalog::FileState::seen) << row.path;
}

TEST_F(LivingChunks, AnEndThatIsCutDoesNotKeepTheVolumeWaiting) {
    for (std::size_t i = 0; i + 1 < names_.size(); ++i)
        take(house_, i);
    const fs::path cut = drop_ / names_.back();
    append_to(cut, parts_.back().first(100));
    EXPECT_EQ(house_.ingestor->ingest(cut, false)->result, IngestResult::incomplete);
    EXPECT_EQ(house_.ingestor->ingest(cut, true)->result, IngestResult::rejected);
    EXPECT_EQ(take(house_, names_.size() - 2, true).result, IngestResult::incomplete);
}

TEST_F(LivingChunks, AVolumeIsMadeAgainAsItIs) {
    for (std::size_t i = 0; i < names_.size(); ++i) {
        if (i != 20) take(house_, i);
    }
    ASSERT_EQ(take(house_, names_.size() - 1, true).result, IngestResult::gridded);
    fs::remove(house_.grids("KLOT").at(0).path);
    EXPECT_EQ(house_.ingestor->ingest_again(drop_ / names_[0])->result, IngestResult::gridded);
    EXPECT_EQ(house_.grids("KLOT").size(), 1U);
    EXPECT_EQ(house_.catalog->list("KLOT", {})->size(), 1U);
}

// 2026-11-22: the volume was forgotten before it was finished, so that one who came meanwhile made
// another, and what failed of the one undid rows of the other.
TEST_F(LivingChunks, WhoComesWhileItIsFinishedDoesNotMakeAnother) {
    for (std::size_t i = 0; i + 1 < names_.size(); ++i)
        take(house_, i);
    append_to(drop_ / names_.back(), parts_.back());
    std::atomic<int> gridded = 0;
    std::vector<std::thread> workers;
    for (std::size_t i = 0; i < 20; ++i) {
        workers.emplace_back([&, i] {
            const fs::path& name = i == 0 ? names_.back() : names_[i];
            std::this_thread::sleep_for(std::chrono::milliseconds{10 * i});
            const auto outcome = house_.ingestor->ingest(drop_ / name, false);
            EXPECT_TRUE(outcome);
            gridded += outcome && outcome->result == IngestResult::gridded ? 1 : 0;
        });
    }
    for (std::thread& worker : workers)
        worker.join();
    EXPECT_EQ(gridded, 1);
    expect_same_cells(house_);
    expect_one_volume(house_);
}

// 2026-11-22: a chunk that could not be read counted as none, and what lay beside the first one as
// not there: the volume was finished without them.
TEST_F(LivingChunks, WithoutDescriptorsTheyAreAskedForAgain) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    GTEST_SKIP()
        << "the sanitizer needs a pipe to look at memory, and takes all for damaged without";
#endif
    take(house_, 0);  // opens the database
    house_.ingestor.reset();
    IngestOptions options;
    options.spacing_m = 4000;
    options.nx = options.ny = 115;
    options.living.scratch = directory_ / "living";
    house_.ingestor.emplace(*house_.catalog, *house_.store, options);
    for (std::size_t i = 1; i < names_.size(); ++i)
        append_to(drop_ / names_[i], parts_[i]);
    rlimit before{};
    ASSERT_EQ(::getrlimit(RLIMIT_NOFILE, &before), 0);
    for (rlim_t most = 3; most < 40; ++most) {
        const rlimit few{most, before.rlim_max};
        ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &few), 0);
        const auto outcome = house_.ingestor->ingest(drop_ / names_.back(), false);
        ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &before), 0);
        if (outcome) {
            EXPECT_EQ(outcome->result, IngestResult::gridded) << most;
            break;
        }
        EXPECT_EQ(outcome.error().code, ErrorCode::io) << outcome.error().message;
        EXPECT_NE(outcome.error().message.find("Too many open files"), std::string::npos)
            << outcome.error().message;
    }
    expect_same_cells(house_);
    expect_one_volume(house_);
}

// After a power cut: the newest chunk is empty and is the first that is looked at.
TEST_F(LivingChunks, OneThatIsNotWholeIsNoneToWaitFor) {
    for (std::size_t i = 0; i + 2 < names_.size(); ++i)
        append_to(drop_ / names_[i], parts_[i]);
    const fs::path empty = drop_ / names_[names_.size() - 2];
    std::ofstream{empty};
    ASSERT_EQ(house_.ingestor->ingest(empty, false)->result, IngestResult::incomplete);
    // The next that is asked is waited for in its place.
    EXPECT_EQ(take(house_, 3).result, IngestResult::incomplete);
    EXPECT_EQ(take(house_, 4).result, IngestResult::registered);
}

TEST_F(LivingChunks, WorkersThatComeTogetherMakeItOnce) {
    for (std::size_t i = 0; i < names_.size(); ++i)
        append_to(drop_ / names_[i], parts_[i]);
    std::vector<std::thread> workers;
    std::atomic<std::size_t> next = 0;
    std::atomic<int> gridded = 0;
    for (int i = 0; i < 4; ++i) {
        workers.emplace_back([&] {
            for (std::size_t at = next++; at < names_.size(); at = next++) {
                const auto outcome = house_.ingestor->ingest(drop_ / names_[at], false);
                gridded += outcome && outcome->result == IngestResult::gridded ? 1 : 0;
            }
        });
    }
    for (std::thread& worker : workers)
        worker.join();
    EXPECT_EQ(gridded, 1);
    expect_same_cells(house_);
    expect_one_volume(house_);
    for (const std::string& name : names_) {
        EXPECT_EQ(house_.ingestor->ingest(drop_ / name, true)->result, IngestResult::unchanged);
    }
}

TEST_F(Living, ChunksBelongTogetherByAllOfTheirNamesButTheirNumbers) {
    const auto key = [](const char* name) { return ChunkPath::of(name)->key; };
    const std::string one = key("/d/20220317-000842-012-I-KTLX");
    EXPECT_EQ(one, key("/d/20220317-000842-1-S-KTLX"));
    EXPECT_NE(one, key("/d/20220317-000842-012-I-KOUN"));
    EXPECT_NE(one, key("/e/20220317-000842-012-I-KTLX"));
    EXPECT_NE(one, key("/d/KTLX-20220317-000842-012-I"));
    EXPECT_EQ(key("/d/20220317-000842_20220317-000842-012-I"),
              key("/d/20220317-000842_20220317-000842-13-E"));
    EXPECT_FALSE(ChunkPath::of("/d/KTLX20220317_000842_V06"));
}

TEST_F(LivingChunks, OneThatIsNoneIsRejectedByItself) {
    for (std::size_t i = 0; i < 10; ++i)
        take(house_, i);
    const fs::path path = drop_ / "20220317-000842-011-I";
    append_to(path, std::vector<std::byte>(5000, std::byte{7}));
    EXPECT_EQ(house_.ingestor->ingest(path, true)->result, IngestResult::rejected);
    EXPECT_EQ(take(house_, 9, true).result, IngestResult::incomplete) << "the volume goes on";
}

TEST_F(Living, BeyondTheLimitTheOldestIsGivenUp) {
    LivingFiles files(LivingFile::Options{{}, level2::Moment::ref, {}, directory_ / "living"},
                      LivingLimits{.files = 2});
    const auto a = files.begin("/drop/a", "KTLX");
    const auto b = files.begin("/drop/b", "KTLX");
    ASSERT_TRUE(a && b);
    files.grew("/drop/a", *a);
    const auto c = files.begin("/drop/c", "KTLX");
    EXPECT_EQ(files.count(), 2U);
    EXPECT_EQ(files.find("/drop/a"), a);
    EXPECT_EQ(files.find("/drop/b"), nullptr);
    EXPECT_EQ(files.find("/drop/c"), c);
    files.forget("/drop/a");
    EXPECT_EQ(files.find("/drop/a"), nullptr);
}

TEST_F(Living, GrowthIsToldByTheRecords) {
    const std::vector<std::byte> bytes = real_bytes(busy);
    const fs::path path = directory_ / "KLOT20220317_000842_V06";
    append_to(path, std::span{bytes}.first(24));
    EXPECT_TRUE(LivingFile::is_growing(path));
    append_to(path, std::span{bytes}.subspan(24, 1'000'000));
    EXPECT_TRUE(LivingFile::is_growing(path));
    append_to(path, std::span{bytes}.subspan(1'000'024));
    EXPECT_FALSE(LivingFile::is_growing(path));  // whole: its last record says so
    EXPECT_FALSE(
        LivingFile::is_growing(*testing::data_directory() / "volumes/KLIX20050828_180149.gz"));
    EXPECT_FALSE(LivingFile::is_growing(directory_.path()));
    EXPECT_FALSE(LivingFile::is_growing(directory_ / "nothing"));
}

TEST_F(Living, SweepsComeBackFromTheShelfBitForBit) {
    for (const char* name : {busy, "volumes/KTLX19990503_235621.gz"}) {
        const level2::Volume volume = level2::decode(real_bytes(name))->volume;
        const auto shelf = SweepShelf::make_in(directory_.path());
        ASSERT_TRUE(shelf);
        std::vector<SweepShelf::Place> places;
        for (const level2::Sweep& sweep : volume.sweeps)
            places.push_back((*shelf)->put(sweep).value());
        level2::Volume back = volume;
        for (std::size_t i = 0; i < places.size(); ++i)
            back.sweeps[i] = (*shelf)->get(places[i]).value();
        EXPECT_EQ(level2::difference(volume, back), "") << name;
        EXPECT_GT((*shelf)->bytes(), 0U);
        // Damaged places give errors, not sweeps.
        SweepShelf::Place beyond = places.back();
        beyond.offset += 1'000'000'000;
        EXPECT_FALSE((*shelf)->get(beyond));
        SweepShelf::Place shifted = places.back();
        shifted.offset -= 1;
        EXPECT_FALSE((*shelf)->get(shifted));
    }
    EXPECT_FALSE(SweepShelf::make_in(directory_ / "nowhere"));
}

TEST(Xxh3Stream, IsThatOfAllBytesWhereverTheyAreCut) {
    std::vector<std::byte> bytes(100'000);
    for (std::size_t i = 0; i < bytes.size(); ++i)
        bytes[i] = static_cast<std::byte>(i * i >> 3U);
    for (const std::size_t cut : {std::size_t{0}, std::size_t{1}, std::size_t{999}, bytes.size()}) {
        Xxh3Stream stream;
        stream.append(std::span{bytes}.first(cut));
        stream.append(std::span{bytes}.subspan(cut));
        EXPECT_EQ(stream.value(), xxh3_64(bytes));
    }
    EXPECT_EQ(Xxh3Stream{}.value(), xxh3_64({}));
}

}  // namespace
}  // namespace stormcellar::pipeline
