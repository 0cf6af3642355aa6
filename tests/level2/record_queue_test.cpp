#include "level2/decode/record_queue.h"

#include <gtest/gtest.h>

#include "tests/level2/no_limits.h"
#include "tests/level2/wire.h"

namespace stormcellar::level2 {
namespace {

wire::Bytes many_records(unsigned count) {
    wire::Bytes all;
    for (unsigned i = 0; i < count; ++i) {
        const wire::Bytes messages = wire::radial_messages(1, 1 + i % 7, 50 + i);
        all = wire::join({all, wire::ldm_record(messages)});
    }
    return all;
}

RecordQueue::Source source_of(std::span<const std::byte> bytes) {
    return [framer = LdmFramer{bytes}]() mutable { return framer.next(); };
}

TEST(RecordQueue, OrderAndContentsDoNotDependOnTheThreads) {
    const wire::Bytes bytes = many_records(60);
    for (const int threads : {1, 2, 3, 8}) {
        RecordQueue queue{source_of(bytes), threads, ample, everything};
        unsigned i = 0;
        for (; const auto fragment = queue.next(ample); ++i) {
            ASSERT_EQ(fragment->pieces.size(), 1U);
            EXPECT_EQ(fragment->pieces[0].sweep.radials.size(), 1 + i % 7);
            EXPECT_EQ(fragment->pieces[0].sweep.moments.at(0).gate_stride, 50 + i);
            EXPECT_EQ(fragment->report.ldm_records, 1U);
        }
        EXPECT_EQ(i, 60) << threads;
    }
}

TEST(RecordQueue, CanBeLeftEarly) {
    const wire::Bytes bytes = many_records(60);
    for (int taken = 0; taken < 3; ++taken) {
        RecordQueue queue{source_of(bytes), 4, ample, everything};
        for (int i = 0; i < taken; ++i)
            EXPECT_TRUE(queue.next(ample));
    }
}

TEST(RecordQueue, ARecordBeyondTheLimitSaysSo) {
    const wire::Bytes bytes = wire::ldm_record(wire::Bytes(2'000'000));
    RecordQueue queue{source_of(bytes), 2, 1'000'000, everything};
    const auto fragment = queue.next(ample);
    ASSERT_TRUE(fragment);
    EXPECT_EQ(fragment->failure, Fragment::Failure::too_much_output);
    EXPECT_FALSE(queue.next(ample));
}

}  // namespace
}  // namespace stormcellar::level2
