// stormcellar/base/mutex.h -- mutexes whose use clang can check.
//
// A shared member names its mutex, as in `int count_ STORMCELLAR_GUARDED_BY(mutex_) = 0;`. A
// function that must be called with the mutex held names it, too, as in `void add()
// STORMCELLAR_REQUIRES(mutex_);`. scripts/check-locks compiles with clang's -Wthread-safety, which
// refuses an access to the member, or a call of the function, without the lock. The analysis
// ignores constructors and destructors. It treats a lambda as a separate function, so a lambda that
// runs under the lock needs STORMCELLAR_REQUIRES, too, and a wait must be a loop without a lambda,
// as in `while (!is_done_) changed_.wait(mutex_);`.
//
// Cost      None beyond the standard library's mutexes. With gcc the macros are empty.
// Threads   Any thread.
// Errors    None.
#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <shared_mutex>

#ifdef __clang__
#define STORMCELLAR_LOCK_ATTRIBUTE(...) __attribute__((__VA_ARGS__))
#else
#define STORMCELLAR_LOCK_ATTRIBUTE(...)
#endif

// GUARDED_BY is for a member that is used only with the mutex held. POINTEE_GUARDED_BY is for a
// pointer to an object that is used only with the mutex held.
#define STORMCELLAR_GUARDED_BY(mutex) STORMCELLAR_LOCK_ATTRIBUTE(guarded_by(mutex))
#define STORMCELLAR_POINTEE_GUARDED_BY(mutex) STORMCELLAR_LOCK_ATTRIBUTE(pt_guarded_by(mutex))
// REQUIRES is for a function that must be called with the mutex held, REQUIRES_SHARED with the
// mutex held at least for reading, and EXCLUDES with the mutex not held.
#define STORMCELLAR_REQUIRES(...) STORMCELLAR_LOCK_ATTRIBUTE(requires_capability(__VA_ARGS__))
#define STORMCELLAR_REQUIRES_SHARED(...) \
    STORMCELLAR_LOCK_ATTRIBUTE(requires_shared_capability(__VA_ARGS__))
#define STORMCELLAR_EXCLUDES(...) STORMCELLAR_LOCK_ATTRIBUTE(locks_excluded(__VA_ARGS__))
// For a function that locks or unlocks the mutex or, without an argument, its own object.
#define STORMCELLAR_ACQUIRE(...) STORMCELLAR_LOCK_ATTRIBUTE(acquire_capability(__VA_ARGS__))
#define STORMCELLAR_ACQUIRE_SHARED(...) \
    STORMCELLAR_LOCK_ATTRIBUTE(acquire_shared_capability(__VA_ARGS__))
#define STORMCELLAR_RELEASE(...) STORMCELLAR_LOCK_ATTRIBUTE(release_capability(__VA_ARGS__))
#define STORMCELLAR_RELEASE_SHARED(...) \
    STORMCELLAR_LOCK_ATTRIBUTE(release_shared_capability(__VA_ARGS__))
#define STORMCELLAR_TRY_ACQUIRE(...) STORMCELLAR_LOCK_ATTRIBUTE(try_acquire_capability(__VA_ARGS__))
// For a function that tells the analysis that the mutex is held.
#define STORMCELLAR_ASSERT_HELD(mutex) STORMCELLAR_LOCK_ATTRIBUTE(assert_capability(mutex))
// For a function that the analysis must ignore. A comment must give the reason.
#define STORMCELLAR_NO_LOCK_ANALYSIS STORMCELLAR_LOCK_ATTRIBUTE(no_thread_safety_analysis)

namespace stormcellar {

class STORMCELLAR_LOCK_ATTRIBUTE(capability("mutex")) Mutex {
  public:
    void lock() STORMCELLAR_ACQUIRE() { native_.lock(); }
    void unlock() STORMCELLAR_RELEASE() { native_.unlock(); }
    [[nodiscard]] bool try_lock() STORMCELLAR_TRY_ACQUIRE(true) { return native_.try_lock(); }

  private:
    friend class ConditionVariable;
    std::mutex native_;
};

// Many threads at once may hold this mutex for reading, or one thread for writing.
class STORMCELLAR_LOCK_ATTRIBUTE(capability("mutex")) SharedMutex {
  public:
    void lock() STORMCELLAR_ACQUIRE() { native_.lock(); }
    void unlock() STORMCELLAR_RELEASE() { native_.unlock(); }
    void lock_shared() STORMCELLAR_ACQUIRE_SHARED() { native_.lock_shared(); }
    void unlock_shared() STORMCELLAR_RELEASE_SHARED() { native_.unlock_shared(); }

  private:
    std::shared_mutex native_;
};

// Holds a mutex while it lives; holds a SharedMutex for writing.
template <class AnyMutex = Mutex>
class STORMCELLAR_LOCK_ATTRIBUTE(scoped_lockable) [[nodiscard]] MutexLock {
  public:
    explicit MutexLock(AnyMutex& mutex) STORMCELLAR_ACQUIRE(mutex) : mutex_(mutex) {
        mutex_.lock();
    }
    ~MutexLock() STORMCELLAR_RELEASE() { mutex_.unlock(); }
    MutexLock(const MutexLock&) = delete;
    MutexLock& operator=(const MutexLock&) = delete;

  private:
    AnyMutex& mutex_;
};

// Holds a SharedMutex for reading while it lives.
class STORMCELLAR_LOCK_ATTRIBUTE(scoped_lockable) [[nodiscard]] SharedLock {
  public:
    explicit SharedLock(SharedMutex& mutex) STORMCELLAR_ACQUIRE_SHARED(mutex) : mutex_(mutex) {
        mutex_.lock_shared();
    }
    ~SharedLock() STORMCELLAR_RELEASE() { mutex_.unlock_shared(); }
    SharedLock(const SharedLock&) = delete;
    SharedLock& operator=(const SharedLock&) = delete;

  private:
    SharedMutex& mutex_;
};

// Unlocks a mutex that the thread holds, and locks it again when destroyed.
class STORMCELLAR_LOCK_ATTRIBUTE(scoped_lockable) [[nodiscard]] MutexUnlock {
  public:
    explicit MutexUnlock(Mutex& mutex) STORMCELLAR_RELEASE(mutex) : mutex_(mutex) {
        mutex_.unlock();
    }
    ~MutexUnlock() STORMCELLAR_RELEASE() { mutex_.lock(); }
    MutexUnlock(const MutexUnlock&) = delete;
    MutexUnlock& operator=(const MutexUnlock&) = delete;

  private:
    Mutex& mutex_;
};

// A wait unlocks the mutex, sleeps until a notification (or wakes up without one), and locks the
// mutex again.
class ConditionVariable {
  public:
    void notify_one() noexcept { native_.notify_one(); }
    void notify_all() noexcept { native_.notify_all(); }

    void wait(Mutex& mutex) STORMCELLAR_REQUIRES(mutex) {
        Adopted lock(mutex);
        native_.wait(lock.native);
    }
    template <class Clock, class Duration>
    std::cv_status wait_until(Mutex& mutex, const std::chrono::time_point<Clock, Duration>& end)
        STORMCELLAR_REQUIRES(mutex) {
        Adopted lock(mutex);
        return native_.wait_until(lock.native, end);
    }
    template <class Rep, class Period>
    std::cv_status wait_for(Mutex& mutex, const std::chrono::duration<Rep, Period>& duration)
        STORMCELLAR_REQUIRES(mutex) {
        Adopted lock(mutex);
        return native_.wait_for(lock.native, duration);
    }

  private:
    // The caller's lock, in the form that a standard condition variable needs. The caller still
    // unlocks it.
    struct Adopted {
        explicit Adopted(Mutex& mutex) : native(mutex.native_, std::adopt_lock) {}
        ~Adopted() { native.release(); }
        std::unique_lock<std::mutex> native;
    };
    std::condition_variable native_;
};

}  // namespace stormcellar
