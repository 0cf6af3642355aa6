// Tests volumes of chunks that come in any order, are lost in part, and are ingested by several
// workers.
#include <algorithm>
#include <array>
#include <atomic>
#include <fstream>
#include <thread>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include "pipeline/ingest/chunk_volumes.h"
#include "stormcellar/cache/grid_file.h"
#include "tests/pipeline/living_house.h"
#include "tests/testing/waiting.h"

namespace stormcellar::pipeline {
namespace {

TEST_F(LivingChunks, MakeTheVolumeThatTheWholeFileHolds) {
    std::size_t shown = 0;
    for (std::size_t i = 0; i + 1 < names_.size(); ++i) {
        const IngestOutcome outcome = take(house_, i);
        EXPECT_EQ(outcome.result(), IngestResult::incomplete) << i;
        shown += outcome.living.size();
    }
    EXPECT_GT(shown, 5U);
    EXPECT_EQ(take(house_, 0, true).result(), IngestResult::registered)
        << "the first chunk does not represent the volume";
    EXPECT_EQ(take(house_, names_.size() - 2, true).result(), IngestResult::incomplete);
    const IngestOutcome last = take(house_, names_.size() - 1);
    EXPECT_EQ(last.result(), IngestResult::gridded);
    EXPECT_EQ(last.station, "KLOT");
    expect_the_whole_volume_once();
    for (std::size_t i = 0; i < names_.size(); ++i)
        EXPECT_EQ(take(house_, i, true).result(), IngestResult::unchanged) << i;
}

// 2026-11-26: a volume of chunks could not be listed or read before it had ended.
TEST_F(LivingChunks, TheRowOfTheFirstDescribesTheVolumeWhileItGrows) {
    const auto rows = [&] { return *house_.catalog->list("KLOT", {}); };
    const auto whole = whole_.catalog->list("KLOT", {})->at(0).volume;
    take(house_, 0);
    EXPECT_TRUE(rows().empty()) << "only metadata have come";
    std::size_t sweeps = 0, radials = 0;
    for (std::size_t i = 1; i + 1 < names_.size(); ++i) {
        take(house_, i);
        if (i % 10 == 0) take(house_, 0);
        if (rows().empty()) continue;
        ASSERT_EQ(rows().size(), 1U) << i;
        const catalog::CatalogEntry row = rows().at(0);
        EXPECT_EQ(row.path, drop_ / names_[0]);
        EXPECT_EQ(row.state, catalog::FileState::seen);
        EXPECT_EQ(row.generation, 0);
        EXPECT_EQ(row.volume.start_time, whole.start_time);
        EXPECT_GE(row.volume.sweep_count, static_cast<int>(sweeps));
        EXPECT_GE(row.volume.radial_count, static_cast<int>(radials));
        EXPECT_LE(row.volume.end_time, whole.end_time);
        sweeps = static_cast<std::size_t>(row.volume.sweep_count);
        radials = static_cast<std::size_t>(row.volume.radial_count);
    }
    EXPECT_GT(sweeps, 5U);
    EXPECT_GT(radials, 3000U);
    take(house_, names_.size() - 1);
    expect_one_volume(house_);
    EXPECT_EQ(rows().at(0).generation, 0);
    EXPECT_EQ(rows().at(0).state, catalog::FileState::complete);
}

// 2026-11-28: while the volume was gridded, its row described the complete volume, but the last
// chunk had no row, so readers left that chunk out.
TEST_F(LivingChunks, TheRowTellsOfTheWholeVolumeWhenAllHaveRows) {
    for (std::size_t i = 0; i + 1 < names_.size(); ++i)
        take(house_, i);
    const auto whole = whole_.catalog->list("KLOT", {})->at(0).volume;
    std::atomic<bool> is_done = false;
    std::size_t looks = 0, too_early = 0;
    std::thread reader([&] {
        const auto catalog = catalog::CatalogReader::open(directory_ / "living/catalog");
        while (!is_done) {
            const auto first = catalog->list("KLOT", {});
            if (first->at(0).volume.radial_count != whole.radial_count) continue;
            ++looks;
            const auto all = catalog->list("KLOT", {std::nullopt, std::nullopt, true});
            too_early += all->size() == names_.size() ? 0 : 1;
        }
    });
    take(house_, names_.size() - 1);
    is_done = true;
    reader.join();
    EXPECT_GT(looks, 0U);
    EXPECT_EQ(too_early, 0U);
    expect_one_volume(house_);
}

TEST_F(LivingChunks, MayComeInAnyOrder) {
    std::vector<std::size_t> order(names_.size());
    for (std::size_t i = 0; i < order.size(); ++i)
        order[i] = (i * 17 + 5) % order.size();  // 55 has no factor 17
    for (std::size_t i = 0; i + 1 < order.size(); ++i)
        EXPECT_NE(take(house_, order[i]).result(), IngestResult::gridded) << order[i];
    EXPECT_EQ(take(house_, order.back()).result(), IngestResult::gridded);
    expect_the_whole_volume_once();
}

TEST_F(LivingChunks, AreTakenUpByAnotherProcess) {
    for (std::size_t i = 0; i < 30; ++i)
        take(house_, i);
    begin_again_with(most_shelf_bytes);
    for (std::size_t i = 30; i < names_.size(); ++i)
        take(house_, i);
    expect_the_whole_volume_once();
}

TEST_F(LivingChunks, OneThatIsLostLeavesAPartialVolumeUntilItComes) {
    for (std::size_t i = 0; i < names_.size(); ++i) {
        if (i == 20) continue;
        EXPECT_NE(take(house_, i).result(), IngestResult::gridded);
    }
    const IngestOutcome partial = take(house_, names_.size() - 1, true);
    EXPECT_EQ(partial.result(), IngestResult::gridded);
    EXPECT_TRUE(partial.partial);
    EXPECT_NE(partial.reason.find("missing chunks: 21"), std::string::npos) << partial.reason;
    EXPECT_EQ(take(house_, 20).result(), IngestResult::gridded);
    expect_the_whole_volume_once();
}

// 2026-11-23: the first radial names a volume until its header comes, and then grids with both
// names stayed.
TEST_F(LivingChunks, TheBeginningThatComesLateLeavesNoOtherGrid) {
    constexpr std::size_t late = 10;
    for (std::size_t i = late; i < names_.size(); ++i)
        take(house_, i);
    ASSERT_EQ(take(house_, names_.size() - 1, true).result(), IngestResult::gridded);
    ASSERT_EQ(house_.grids("KLOT").size(), 1U);
    const UtcTime first_radial = house_.grids("KLOT")[0].time;
    // A grid of another volume stays.
    const fs::path beside =
        house_.grids("KLOT")[0].path.parent_path() / "KLOT_REF_20220317_000500_000.scg";
    fs::copy_file(whole_.grids("KLOT")[0].path, beside);
    for (std::size_t i = 0; i < late; ++i)
        take(house_, i);
    EXPECT_TRUE(fs::remove(beside));
    ASSERT_EQ(house_.grids("KLOT").size(), 1U);
    EXPECT_LT(house_.grids("KLOT")[0].time, first_radial);
    expect_the_whole_volume_once();
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
    ASSERT_EQ(take(house_, names_.size() - 1, true).result(), IngestResult::gridded);
    EXPECT_TRUE(notes().empty()) << "the grid should be final, not living";
    EXPECT_EQ(take(house_, 20).result(), IngestResult::incomplete)
        << "the late chunk represents the volume";
    EXPECT_TRUE(notes().empty()) << "a living grid must not replace a final grid";
    const IngestOutcome again = take(house_, 20, true);
    EXPECT_EQ(again.result(), IngestResult::gridded);
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
    EXPECT_EQ(house_.ingestor->ingest(cut, false)->result(), IngestResult::incomplete);
    EXPECT_EQ(house_.ingestor->ingest(cut, true)->result(), IngestResult::rejected);
    EXPECT_EQ(take(house_, names_.size() - 2, true).result(), IngestResult::incomplete);
}

// 2026-11-22: the chunk by which a volume is polled (its representative) was deleted before the
// volume was due, and the volume was not polled again before the next start.
TEST_F(LivingChunks, AWaiterThatIsDeletedStillWaits) {
    for (std::size_t i = 0; i < names_.size(); ++i) {
        if (i != 20) take(house_, i);
    }
    const fs::path representative = drop_ / names_.back();
    fs::remove(representative);
    EXPECT_EQ(house_.ingestor->note(representative).value(), Noted::stands);
    const auto gone = house_.ingestor->ingest(representative, false);
    ASSERT_TRUE(gone) << gone.error().message;
    EXPECT_EQ(gone->result(), IngestResult::incomplete);
    fs::remove(drop_ / names_[3]);
    EXPECT_EQ(house_.ingestor->ingest(drop_ / names_[3], false)->result(), IngestResult::vanished);
    const auto outcome = house_.ingestor->ingest(representative, true);
    ASSERT_TRUE(outcome) << outcome.error().message;
    EXPECT_EQ(outcome->result(), IngestResult::gridded);
    EXPECT_TRUE(outcome->partial);
    EXPECT_EQ(outcome->missing_chunks, std::vector<int>{21})
        << "deleted chunks were read before, so they are not missing";
    EXPECT_NE(outcome->reason.find("was deleted"), std::string::npos) << outcome->reason;
    const auto rows = house_.catalog->list("KLOT", {std::nullopt, std::nullopt, true});
    ASSERT_EQ(rows->size(), names_.size() - 1);
    for (const auto& row : *rows) {
        EXPECT_EQ(row.state == catalog::FileState::gone, !fs::exists(row.path)) << row.path;
        EXPECT_NE(row.state, catalog::FileState::seen) << row.path;
    }
    EXPECT_EQ(house_.ingestor->ingest(representative, true)->result(), IngestResult::vanished)
        << "the deleted representative should be polled no more";
}

TEST_F(LivingChunks, ADeletedWaiterIsRelievedByTheNextChunk) {
    for (std::size_t i = 0; i < 10; ++i)
        take(house_, i);
    const fs::path representative = drop_ / names_[9];
    fs::remove(representative);
    EXPECT_EQ(house_.ingestor->ingest(representative, true)->result(), IngestResult::incomplete)
        << "the volume is not due, because its end has not come";
    const IngestOutcome next = take(house_, 10);
    EXPECT_EQ(next.result(), IngestResult::incomplete);
    EXPECT_EQ(next.former_representative, representative);
    EXPECT_EQ(house_.ingestor->ingest(representative, true)->result(), IngestResult::vanished);
    EXPECT_EQ(house_.ingestor->note(representative).value(), Noted::gone);
    for (std::size_t i = 11; i < names_.size(); ++i)
        take(house_, i);
    expect_same_cells(house_);
}

// 2026-11-25: a hundred files with the names of chunks kept a worker busy for minutes, several
// times.
TEST_F(LivingChunks, OfSiblingsThatAreNoneFewAreReadInOneJob) {
    const fs::path directory = directory_ / "others";
    fs::create_directories(directory);
    append_to(directory / names_[0], parts_[0]);
    const std::vector<std::byte> rubbish(5000, std::byte{'x'});
    for (std::size_t i = 1; i <= 10; ++i)
        append_to(directory / names_[i], rubbish);
    append_to(directory / names_[11], parts_[11]);
    FollowedFile::Options options;
    options.scratch = directory_ / "living";
    ChunkVolumes volumes(options);
    const auto first = ChunkPath::of(directory / names_[0]).value();
    const auto volume = volumes.find(first, "A")->lock();
    ASSERT_TRUE(volume->add_with_siblings(first, stamp_of(first.path).value()));
    EXPECT_EQ(volume->files().size(), 1U)
        << "after four files that are not chunks, the job should stop";
    const auto later = ChunkPath::of(directory / names_[11]).value();
    EXPECT_EQ(volume->add(later, stamp_of(later.path).value()).value(), ChunkVolume::Added::added)
        << "the chunk should be added by its own job";
    const auto refused = ChunkPath::of(directory / names_[1]).value();
    fs::permissions(refused.path, fs::perms::none);  // has no effect for root
    EXPECT_EQ(volume->add(refused, stamp_of(refused.path).value()).value(),
              ChunkVolume::Added::not_ours)
        << "a refused file should not be read again";
}

// 2026-11-22: the sweeps of chunks that wait on disk (on the shelf) had no limit.
TEST_F(LivingChunks, WhatHasNotGrownForLongestMakesRoom) {
    const auto grow = [&](ChunkVolumes& volumes, const std::string& site) {
        const auto directory = directory_ / "others" / site;
        fs::create_directories(directory);
        bool has_its_share = true;
        for (std::size_t i = 0; i < 12; ++i) {
            const auto chunk = ChunkPath::of(directory / names_[i]).value();
            append_to(chunk.path, parts_[i]);
            const auto volume = volumes.find(chunk, site);
            if (!volume) return std::pair(false, chunk);
            const auto held = volume->lock();
            EXPECT_TRUE(held->add(chunk, stamp_of(chunk.path).value()));
            has_its_share = volumes.grew(chunk, volume, held->growth(), site) && has_its_share;
        }
        return std::pair(has_its_share, ChunkPath::of(directory / names_[0]).value());
    };
    FollowedFile::Options options;
    options.scratch = directory_ / "living";
    ChunkVolumes ample(options);
    const auto first = grow(ample, "A").second;
    const std::uint64_t of_one = ample.find_known(first)->lock()->growth().shelf_bytes;
    EXPECT_GT(of_one, 1'000'000U);
    grow(ample, "B");
    EXPECT_EQ(ample.count(), 2U);
    EXPECT_EQ(ample.take_given_up(), 0U);

    fs::remove_all(directory_ / "others");
    ChunkVolumes scarce(options, GrowingLimits{.shelf_bytes = of_one * 5 / 2});
    grow(scarce, "A");
    grow(scarce, "B");
    EXPECT_EQ(scarce.count(), 2U);
    grow(scarce, "C");
    EXPECT_EQ(scarce.count(), 2U) << "one of three equally large volumes should be given up";
    EXPECT_EQ(scarce.take_given_up(), 1U);
    EXPECT_EQ(scarce.take_given_up(), 0U);

    fs::remove_all(directory_ / "others");
    ChunkVolumes each(options, GrowingLimits{.station_shelf_bytes = of_one / 2});
    const auto [has_its_share, given_up] = grow(each, "A");
    EXPECT_FALSE(has_its_share);
    EXPECT_EQ(each.take_given_up(), 1U);
    EXPECT_EQ(each.find(given_up, "A"), nullptr)
        << "a volume that was given up should not be read with each chunk";
    const auto at_its_end = each.find(given_up, "A", ChunkVolumes::Expected::its_end_is_there);
    ASSERT_TRUE(at_its_end) << "a volume that was given up gets one more try at its end";
    const auto held = at_its_end->lock();
    EXPECT_TRUE(held->add_with_siblings(given_up, stamp_of(given_up.path).value()));
    EXPECT_FALSE(each.grew(given_up, at_its_end, held->growth(), "A"));
    EXPECT_EQ(each.find(given_up, "A", ChunkVolumes::Expected::its_end_is_there), nullptr)
        << "a second end should not cause another try";
    EXPECT_TRUE(each.find(given_up, "A", ChunkVolumes::Expected::nothing))
        << "a quiet volume is read again";
}

// 2026-11-25: a volume that was given up was only gridded after it had been quiet.
TEST_F(LivingChunks, AVolumeThatWasGivenUpIsGriddedWhenItsEndComes) {
    begin_again_with(4'000'000);
    std::uint64_t given_up = 0;
    for (std::size_t i = 0; i + 1 < names_.size(); ++i)
        given_up += take(house_, i).given_up;
    EXPECT_EQ(given_up, 1U);
    EXPECT_EQ(take(house_, names_.size() - 1).result(), IngestResult::gridded);
    expect_the_whole_volume_once();
}

TEST_F(LivingChunks, WithoutRoomOnDiskTheyAreReadAgain) {
    begin_again_with(4'000'000);
    std::uint64_t given_up = 0;
    std::size_t next = 0;
    for (; next < 20; ++next)
        given_up += take(house_, next).given_up;
    EXPECT_EQ(given_up, 1U) << "the volume should be given up once and not read until it is quiet";
    begin_again_with(most_shelf_bytes);
    for (; next < names_.size(); ++next)
        EXPECT_EQ(take(house_, next).given_up, 0U);
    expect_the_whole_volume_once();
}

TEST_F(LivingChunks, AVolumeIsMadeAgainAsItIs) {
    for (std::size_t i = 0; i < names_.size(); ++i) {
        if (i != 20) take(house_, i);
    }
    ASSERT_EQ(take(house_, names_.size() - 1, true).result(), IngestResult::gridded);
    fs::remove(house_.grids("KLOT").at(0).path);
    EXPECT_EQ(house_.ingestor->ingest_again(drop_ / names_[0])->result(), IngestResult::gridded);
    EXPECT_EQ(house_.grids("KLOT").size(), 1U);
    EXPECT_EQ(house_.catalog->list("KLOT", {})->size(), 1U);
}

// 2026-11-22: the volume was forgotten before it was finished, so that a job that came meanwhile
// made a second object of the same volume. The failure of one object then overwrote rows of the
// other object.
TEST_F(LivingChunks, WhoComesWhileItIsFinishedDoesNotMakeAnother) {
    for (std::size_t i = 0; i + 1 < names_.size(); ++i)
        take(house_, i);
    append_to(drop_ / names_.back(), parts_.back());
    std::atomic<int> gridded = 0;
    std::vector<std::thread> workers;
    for (std::size_t i = 0; i < 20; ++i) {
        workers.emplace_back([&, i] {
            const fs::path& name = i == 0 ? names_.back() : names_[i];
            testing::pass_time(std::chrono::milliseconds{10 * i});
            const auto outcome = house_.ingestor->ingest(drop_ / name, false);
            EXPECT_TRUE(outcome);
            gridded += outcome && outcome->result() == IngestResult::gridded ? 1 : 0;
        });
    }
    for (std::thread& worker : workers)
        worker.join();
    EXPECT_EQ(gridded, 1);
    expect_the_whole_volume_once();
}

// 2026-11-22: a chunk that could not be read counted as no chunk, and the other chunks in the
// directory counted as missing, so the volume was finished without these chunks.
TEST_F(LivingChunks, WithoutDescriptorsTheyAreAskedForAgain) {
#if defined(STORMCELLAR_SANITIZED)
    GTEST_SKIP() << "the sanitizer needs descriptors to check memory";
#endif
    take(house_, 0);  // opens the database
    begin_again_with(most_shelf_bytes);
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
            EXPECT_EQ(outcome->result(), IngestResult::gridded) << most;
            break;
        }
        EXPECT_EQ(outcome.error().cause(), Cause::system) << outcome.error().message;
        EXPECT_NE(outcome.error().message.find("Too many open files"), std::string::npos)
            << outcome.error().message;
    }
    expect_the_whole_volume_once();
}

// After a power cut, the newest chunk is empty, and it is offered first.
TEST_F(LivingChunks, OneThatIsNotWholeIsNoneToWaitFor) {
    for (std::size_t i = 0; i + 2 < names_.size(); ++i)
        append_to(drop_ / names_[i], parts_[i]);
    const fs::path empty = drop_ / names_[names_.size() - 2];
    std::ofstream{empty};
    ASSERT_EQ(house_.ingestor->ingest(empty, false)->result(), IngestResult::incomplete);
    // The next chunk that is offered becomes the representative instead.
    EXPECT_EQ(take(house_, 3).result(), IngestResult::incomplete);
    EXPECT_EQ(take(house_, 4).result(), IngestResult::registered);
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
                gridded += outcome && outcome->result() == IngestResult::gridded ? 1 : 0;
            }
        });
    }
    for (std::thread& worker : workers)
        worker.join();
    EXPECT_EQ(gridded, 1);
    expect_the_whole_volume_once();
    for (const std::string& name : names_) {
        EXPECT_EQ(house_.ingestor->ingest(drop_ / name, true)->result(), IngestResult::unchanged);
    }
}

TEST(ChunkNames, BelongTogetherByAllOfTheirNamesButTheirNumbers) {
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
    const auto rejected = house_.ingestor->ingest(path, true);
    EXPECT_EQ(rejected->result(), IngestResult::rejected);
    EXPECT_EQ(rejected->station, "KLOT") << "the directory names the station";
    EXPECT_EQ(take(house_, 9, true).result(), IngestResult::incomplete)
        << "the volume should continue";
}

}  // namespace
}  // namespace stormcellar::pipeline
