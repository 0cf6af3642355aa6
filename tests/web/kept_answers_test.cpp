#include "web/data/kept_answers.h"

#include <atomic>
#include <future>
#include <thread>

#include <gtest/gtest.h>

namespace stormcellar::web {
namespace {

Kept kept_bytes(std::size_t size) {
    return {text_of(std::string(size, 'x')), "\"e\"", {}};
}

TEST(KeptAnswers, DropTheLeastRecentlyUsed) {
    KeptAnswers kept(4 * 1300);
    for (const char* key : {"a", "b", "c"})
        (void)kept.find_or_make(key, [] { return Result<Kept>(kept_bytes(1000)); });
    ASSERT_TRUE(kept.find("a"));
    for (const char* key : {"d", "e"})
        (void)kept.find_or_make(key, [] { return Result<Kept>(kept_bytes(1000)); });
    EXPECT_TRUE(kept.find("a"));
    EXPECT_FALSE(kept.find("b"));
    EXPECT_LE(kept.bytes(), 4u * 1300);
}

TEST(KeptAnswers, KeepNeitherErrorsNorWhatIsTooLarge) {
    KeptAnswers kept(10'000);
    int made = 0;
    const auto failing = [&]() -> Result<Kept> {
        ++made;
        return fail(ErrorCode::io, "no");
    };
    EXPECT_FALSE(kept.find_or_make("a", failing));
    EXPECT_FALSE(kept.find_or_make("a", failing));
    EXPECT_EQ(made, 2);
    const auto large = kept.find_or_make("b", [] { return Result<Kept>(kept_bytes(5'000)); });
    EXPECT_EQ((*large).bytes->size(), 5'000u);
    EXPECT_FALSE(kept.find("b"));
}

TEST(KeptAnswers, AreMadeOnceForAllWhoWait) {
    KeptAnswers kept(1'000'000);
    std::atomic<int> made = 0;
    std::promise<void> go_on;
    const std::shared_future<void> released = go_on.get_future().share();
    std::vector<std::thread> threads;
    std::atomic<int> right = 0;
    for (int i = 0; i < 8; ++i) {
        threads.emplace_back([&] {
            const auto value = kept.find_or_make("a", [&]() -> Result<Kept> {
                ++made;
                released.wait();
                return kept_bytes(100);
            });
            if (value && value->bytes->size() == 100) ++right;
        });
    }
    go_on.set_value();
    for (std::thread& thread : threads)
        thread.join();
    EXPECT_EQ(made, 1);
    EXPECT_EQ(right, 8);
}

TEST(KeptAnswers, ForgetByTheBeginningOfTheKey) {
    KeptAnswers kept(1'000'000);
    for (const char* key : {"KTLX/1", "KTLX/2", "KOKX/1"})
        (void)kept.find_or_make(key, [] { return Result<Kept>(kept_bytes(10)); });
    kept.forget("KTLX/");
    EXPECT_FALSE(kept.find("KTLX/1"));
    EXPECT_FALSE(kept.find("KTLX/2"));
    EXPECT_TRUE(kept.find("KOKX/1"));
}

}  // namespace
}  // namespace stormcellar::web
