// Tests that locks exclude, that readers share, and that a wait unlocks its mutex and locks it
// again. scripts/check-locks tests the annotations.
#include "stormcellar/base/mutex.h"

#include <chrono>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

namespace stormcellar {
namespace {

// Returns true if nobody holds the mutex. Tries to lock it in another thread, because a thread must
// not try to lock a mutex that it holds.
bool is_free(Mutex& mutex) {
    bool was_free = false;
    std::thread([&] {
        if (!mutex.try_lock()) return;
        was_free = true;
        mutex.unlock();
    }).join();
    return was_free;
}

struct Count {
    Mutex mutex;
    ConditionVariable changed;
    int number STORMCELLAR_GUARDED_BY(mutex) = 0;

    void add(int addend) {
        {
            const MutexLock lock(mutex);
            number += addend;
        }
        changed.notify_all();
    }
};

TEST(Mutex, ALockLastsAsLongAsItsScope) {
    Mutex mutex;
    {
        const MutexLock lock(mutex);
        EXPECT_FALSE(is_free(mutex));
        {
            const MutexUnlock unlocked(mutex);
            EXPECT_TRUE(is_free(mutex));
        }
        EXPECT_FALSE(is_free(mutex));
    }
    EXPECT_TRUE(is_free(mutex));
}

TEST(Mutex, TryLockHoldsTheMutex) {
    Mutex mutex;
    if (!mutex.try_lock()) FAIL() << "the mutex should be free";
    EXPECT_FALSE(is_free(mutex));
    mutex.unlock();
    EXPECT_TRUE(is_free(mutex));
}

TEST(Mutex, ThreadsCountOneAtATime) {
    Count count;
    std::vector<std::thread> threads;
    for (int i = 0; i < 4; ++i) {
        threads.emplace_back([&] {
            for (int k = 0; k < 1000; ++k)
                count.add(1);
        });
    }
    for (std::thread& thread : threads)
        thread.join();
    const MutexLock lock(count.mutex);
    EXPECT_EQ(count.number, 4000);
}

TEST(SharedMutex, ReadersMeetAndAWriterIsAlone) {
    SharedMutex mutex;
    Count reading;
    int number = 0;
    std::vector<std::thread> readers;
    for (int i = 0; i < 2; ++i) {
        readers.emplace_back([&] {
            const SharedLock lock(mutex);
            reading.add(1);
            const MutexLock together(reading.mutex);
            while (reading.number < 2)  // endless if the other reader must wait
                reading.changed.wait(reading.mutex);
        });
    }
    for (std::thread& reader : readers)
        reader.join();
    std::vector<std::thread> writers;
    for (int i = 0; i < 4; ++i) {
        writers.emplace_back([&] {
            for (int k = 0; k < 1000; ++k) {
                const MutexLock lock(mutex);
                ++number;
            }
        });
    }
    for (std::thread& writer : writers)
        writer.join();
    const SharedLock lock(mutex);
    EXPECT_EQ(number, 4000);
}

TEST(ConditionVariable, AWaitGivesUpTheMutexUntilItIsNotified) {
    Count count;
    std::thread other;
    {
        const MutexLock lock(count.mutex);
        other = std::thread([&] { count.add(1); });  // waits until wait() unlocks the mutex
        while (count.number == 0)
            count.changed.wait(count.mutex);
        EXPECT_EQ(count.number, 1);
        EXPECT_FALSE(is_free(count.mutex));
    }
    other.join();
    EXPECT_TRUE(is_free(count.mutex));
}

TEST(ConditionVariable, AWaitEndsAtItsTimeWithTheMutexHeld) {
    Count count;
    const MutexLock lock(count.mutex);
    const auto end = std::chrono::steady_clock::now() + std::chrono::milliseconds{1};
    while (count.changed.wait_until(count.mutex, end) == std::cv_status::no_timeout) {
    }
    EXPECT_GE(std::chrono::steady_clock::now(), end);
    while (count.changed.wait_for(count.mutex, std::chrono::milliseconds{1}) ==
           std::cv_status::no_timeout) {
    }
    EXPECT_FALSE(is_free(count.mutex));
}

}  // namespace
}  // namespace stormcellar
