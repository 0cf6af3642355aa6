// Tests that near the limits the result is the same for any number of threads and any pieces.
#include <gtest/gtest.h>

#include "stormcellar/level2/growing_volume.h"
#include "tests/level2/same_volume.h"
#include "tests/level2/wire.h"

namespace stormcellar::level2 {
namespace {

using wire::Bytes;

std::string outcome_differs(const Result<Decoded>& a, const Result<Decoded>& b) {
    if (a && b) return difference(*a, *b);
    if (a) return "only the second fails: " + b.error().message;
    if (b) return "only the first fails: " + a.error().message;
    return a.error().message == b.error().message ? ""
                                                  : a.error().message + " / " + b.error().message;
}

// Returns a file with records of several sizes. One record has a block with a wrong checksum.
Bytes damaged_volume() {
    Bytes file = wire::archive_header();
    for (unsigned i = 0; i < 12; ++i) {
        Bytes record =
            wire::ldm_record(wire::radial_messages(1, 20 + 10 * (i % 4), 1500), false, 1);
        if (i == 5) record[record.size() / 2] ^= std::byte{0xFF};
        file = wire::join({file, record});
    }
    return file;
}

TEST(Limits, TheOutcomeIsThatOfOneThread) {
    const Bytes file = damaged_volume();
    std::size_t failed = 0, decoded = 0;
    for (std::uint64_t limit = 1000; limit < 5'000'000; limit += limit / 8 + 1) {
        DecodeOptions options;
        options.output_limit_bytes = limit;
        const auto alone = decode(file, options);
        alone ? ++decoded : ++failed;
        for (const int threads : {2, 3, 8}) {
            options.threads = threads;
            EXPECT_EQ(outcome_differs(decode(file, options), alone), "") << limit << " " << threads;
        }
        options.threads = 1;
        GrowingVolume growing{options};
        for (std::size_t at = 0; at < file.size(); at += 777)
            (void)growing.append(
                std::span{file}.subspan(at, std::min<std::size_t>(777, file.size() - at)));
        EXPECT_EQ(outcome_differs(growing.finish(), alone), "") << limit;
    }
    EXPECT_GT(failed, 10U);
    EXPECT_GT(decoded, 5U);
}

TEST(Limits, PlainMessagesInAnyPiecesToo) {
    Bytes file = wire::archive_header();
    for (unsigned gates : {10U, 3000U, 200U, 9000U, 50U})
        file = wire::join({file, wire::radial_messages(1, 40, gates)});
    for (std::uint64_t limit = 1000; limit < 5'000'000; limit += limit / 4 + 1) {
        DecodeOptions options;
        options.output_limit_bytes = limit;
        const auto whole = decode(file, options);
        for (const std::size_t piece : {1000U, 50'000U, 2'000'000U}) {
            GrowingVolume growing{options};
            for (std::size_t at = 0; at < file.size(); at += piece)
                (void)growing.append(
                    std::span{file}.subspan(at, std::min(piece, file.size() - at)));
            EXPECT_EQ(outcome_differs(growing.finish(), whole), "") << limit << " " << piece;
        }
    }
}

}  // namespace
}  // namespace stormcellar::level2
