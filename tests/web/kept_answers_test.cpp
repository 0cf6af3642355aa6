#include "web/data/grids/kept_answers.h"

#include <atomic>
#include <future>
#include <thread>

#include <gtest/gtest.h>

#include "tests/web/asked.h"
#include "web/data/grids/memory_file.h"

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
    EXPECT_EQ(size_of(large->bytes), 5'000u);
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
            if (value && size_of(value->bytes) == 100) ++right;
        });
    }
    go_on.set_value();
    for (std::thread& thread : threads)
        thread.join();
    EXPECT_EQ(made, 1);
    EXPECT_EQ(right, 8);
}

TEST(MemoryFile, HoldsManyBytesAndNoFewOnes) {
    std::string bytes(least_in_memory_file + 12'345, '\0');
    for (std::size_t i = 0; i < bytes.size(); ++i)
        bytes[i] = static_cast<char>(i * 2'654'435'761U >> 24);
    const Piece piece = in_file(text_of(bytes));
    ASSERT_TRUE(std::holds_alternative<FileSlice>(piece));
    EXPECT_EQ(size_of(piece), bytes.size());
    Answer answer;
    answer.body = part_of({piece}, 1000, 300'000 - 1000);
    EXPECT_EQ(body_of(answer), bytes.substr(1000, 300'000 - 1000));
    const Piece small = in_file(text_of(bytes.substr(0, 1000)));
    ASSERT_TRUE(std::holds_alternative<Text>(small));
    EXPECT_EQ(*std::get<Text>(small), bytes.substr(0, 1000));
}

// 2026-11-28: each client that took a range of a kept netCDF file held a copy of the range.
TEST(KeptAnswers, KeepWhatIsLargeInAFileThatRangesShare) {
    KeptAnswers kept(8'000'000);
    const auto large = kept.find_or_make("a", [] { return Result<Kept>(kept_bytes(1'000'000)); });
    ASSERT_TRUE(large);
    const auto* whole = std::get_if<FileSlice>(&large->bytes);
    ASSERT_NE(whole, nullptr);
    const Pieces part = part_of({large->bytes}, 1, 999'999);
    ASSERT_EQ(part.size(), 1u);
    const auto* slice = std::get_if<FileSlice>(&part.front());
    ASSERT_NE(slice, nullptr);
    EXPECT_EQ(slice->file, whole->file);
    EXPECT_EQ(slice->memory_bytes, 1'000'000u);
}

// 2026-11-28: if making a value threw, the threads that waited for the value waited forever.
TEST(KeptAnswers, AnExceptionIsAnErrorAndTheNextOneMakesIt) {
    KeptAnswers kept(1'000'000);
    const auto thrown = kept.find_or_make("a", []() -> Result<Kept> { throw std::bad_alloc(); });
    ASSERT_FALSE(thrown);
    EXPECT_EQ(thrown.error().code, ErrorCode::exhausted);
    EXPECT_TRUE(kept.find_or_make("a", [] { return Result<Kept>(kept_bytes(10)); }));
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
