// Tests that if any allocation fails, nothing is lost and no file is rejected.
#include <cstdint>
#include <new>

#include <gtest/gtest.h>

#include "stormcellar/level2/decode.h"
#include "stormcellar/level2/live_volume.h"
#include "tests/pipeline/living_house.h"
#include "tests/pipeline/scarce_memory.h"

namespace stormcellar::pipeline {
namespace {

// Ingests as the daemon does: an exception becomes an error (daemon/queue/worker_pool.cpp).
Result<IngestOutcome> ingest_with(House& house, const fs::path& path, std::int64_t allocations) {
    try {
        const WithMemoryFor memory(allocations);
        return house.ingestor->ingest(path, false);
    } catch (const std::bad_alloc&) {
        return fail(ErrorCode::exhausted, "thrown");
    }
}

// Ingests a file again and again with a little more memory, until it succeeds. Returns the number
// of failed tries.
int ingest_with_ever_more_memory(House& house, const fs::path& path) {
    int failed = 0;
    for (std::int64_t allocations = 0;; allocations += 1 + allocations / 3) {
        const auto outcome = ingest_with(house, path, allocations);
        if (outcome) {
            EXPECT_NE(outcome->result(), IngestResult::rejected) << outcome->reason;
            EXPECT_TRUE(outcome->reason.empty()) << outcome->reason;
            return failed;
        }
        EXPECT_EQ(outcome.error().code, ErrorCode::exhausted) << outcome.error().message;
        ++failed;
        if (failed > 200) {
            ADD_FAILURE() << path << ": " << outcome.error().message;
            return failed;
        }
    }
}

TEST_F(LivingChunks, WithoutMemoryAreAskedForAgain) {
    int failed = 0;
    for (std::size_t i = 0; i < names_.size(); ++i) {
        append_to(drop_ / names_[i], parts_[i]);
        failed += ingest_with_ever_more_memory(house_, drop_ / names_[i]);
    }
    EXPECT_GT(failed, 200);
    expect_same_cells(house_);
    expect_one_volume(house_);
}

// After a restart, the first job reads all chunks in the directory.
TEST_F(LivingChunks, WithoutMemoryAreAllReadAgain) {
    for (std::size_t i = 0; i < names_.size(); ++i)
        append_to(drop_ / names_[i], parts_[i]);
    EXPECT_GT(ingest_with_ever_more_memory(house_, drop_ / names_[7]), 20);
    expect_same_cells(house_);
    expect_one_volume(house_);
}

TEST_F(Living, WithoutMemoryAFileIsAskedForAgain) {
    const std::vector<std::byte> bytes = real_bytes(busy);
    const fs::path path = directory_ / "KLOT20220317_000842_V06";
    append_to(path, bytes);
    EXPECT_GT(ingest_with_ever_more_memory(house_, path), 20);
    House whole(directory_ / "whole", false);
    ASSERT_EQ(whole.ingestor->ingest(path, false)->result(), IngestResult::gridded);
    ASSERT_EQ(house_.grids("KLOT").size(), 1U);
    const auto a = cache::GridFile::open(house_.grids("KLOT")[0].path);
    const auto b = cache::GridFile::open(whole.grids("KLOT")[0].path);
    EXPECT_TRUE(std::ranges::equal(a->view().codes, b->view().codes));
}

// A followed file loses its decoded data, but the volume loses nothing.
TEST_F(Living, WithoutMemoryAGrowingFileIsBegunAnew) {
    const std::vector<std::byte> bytes = real_bytes(busy);
    const fs::path path = directory_ / "KLOT20220317_000842_V06";
    std::size_t from = 0;
    for (const std::size_t end : synth::piece_ends(bytes)) {
        append_to(path, std::span{bytes}.subspan(from, end - from));
        from = end;
        (void)ingest_with(house_, path, static_cast<std::int64_t>(from % 1000));
        const auto outcome = house_.ingestor->ingest(path, false);
        ASSERT_TRUE(outcome) << outcome.error().message;
        ASSERT_EQ(outcome->result(),
                  end == bytes.size() ? IngestResult::gridded : IngestResult::incomplete);
    }
    House whole(directory_ / "whole", false);
    ASSERT_EQ(whole.ingestor->ingest(path, false)->result(), IngestResult::gridded);
    const auto a = cache::GridFile::open(house_.grids("KLOT").at(0).path);
    const auto b = cache::GridFile::open(whole.grids("KLOT").at(0).path);
    EXPECT_FALSE(a->description().provenance.partial);
    EXPECT_TRUE(std::ranges::equal(a->view().codes, b->view().codes));
}

// 2026-11-22: the error was `unsupported`, as for a file that cannot be decoded.
TEST(NoMemory, IsNotTheDatas) {
    STORMCELLAR_NEED_DATA();
    const std::vector<std::byte> bytes = real_bytes(busy);
    const std::size_t first = synth::piece_ends(bytes).at(3);
    int failed = 0;
    for (std::int64_t allocations = 0; allocations < 60; ++allocations) {
        Result<level2::Decoded> decoded = fail(ErrorCode::internal, "");
        {
            const WithMemoryFor memory(allocations);
            try {
                decoded = level2::decode(std::span{bytes}.first(first), {});
            } catch (const std::bad_alloc&) {
                ADD_FAILURE() << "decode() throws with " << allocations << " allocations";
            }
        }
        if (decoded || !WithMemoryFor::was_refused()) continue;
        ++failed;
        EXPECT_EQ(decoded.error().code, ErrorCode::exhausted) << decoded.error().message;
        level2::LiveVolume volume;
        {
            const WithMemoryFor memory(allocations);
            const auto added =
                volume.add(1, level2::ChunkKind::start, std::span{bytes}.first(first), {});
            if (!added) {
                EXPECT_EQ(added.error().code, ErrorCode::exhausted);
            }
        }
        ASSERT_TRUE(volume.add(1, level2::ChunkKind::start, std::span{bytes}.first(first), {}));
        const auto whole = volume.finish();
        ASSERT_TRUE(whole);
        for (const auto& problem : whole->report.problems)
            EXPECT_NE(problem.code, "bad_chunk") << problem.text();
    }
    EXPECT_GT(failed, 5);
}

}  // namespace
}  // namespace stormcellar::pipeline
