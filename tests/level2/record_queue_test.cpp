#include "level2/record_queue.h"

#include <gtest/gtest.h>

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

TEST(RecordQueue, OrderAndContentsDoNotDependOnTheThreads) {
    const wire::Bytes bytes = many_records(60);
    for (const int threads : {1, 2, 3, 8}) {
        RecordQueue queue{bytes, threads};
        unsigned i = 0;
        for (; const auto item = queue.next(); ++i) {
            const wire::Bytes expected = wire::radial_messages(1, 1 + i % 7, 50 + i);
            ASSERT_TRUE(std::equal(item->output.begin(), item->output.end(), expected.begin(),
                                   expected.end()))
                << i << " with " << threads;
        }
        EXPECT_EQ(i, 60);
    }
}

TEST(RecordQueue, CanBeLeftEarly) {
    const wire::Bytes bytes = many_records(60);
    for (int taken = 0; taken < 3; ++taken) {
        RecordQueue queue{bytes, 4};
        for (int i = 0; i < taken; ++i)
            EXPECT_TRUE(queue.next());
    }
}

TEST(RecordQueue, LargeRecordsAreLeftToTheCaller) {
    const wire::Bytes bytes = wire::ldm_record(wire::Bytes(RecordQueue::held_record_bytes + 1));
    RecordQueue queue{bytes, 2};
    const auto item = queue.next();
    ASSERT_TRUE(item);
    EXPECT_EQ(item->result.status, BzipStatus::too_large);
    EXPECT_TRUE(item->output.empty());
    EXPECT_FALSE(queue.next());
}

}  // namespace
}  // namespace stormcellar::level2
