// pipeline/ingest/guarded.h -- a value that only the holder of its lock can reach.
//
// The value can be reached only through a Locked, and a Locked holds the mutex. So clang's analysis
// of locks need not follow a Locked from function to function.
//
// Inside the pipeline room only. Thread contract: any thread may call lock(); the holder of the
// Locked uses the value. A Locked must not outlive its Guarded.
#pragma once

#include <utility>

#include "stormcellar/base/mutex.h"

namespace stormcellar::pipeline {

template <class T>
class Guarded {
  public:
    template <class... Arguments>
    explicit Guarded(Arguments&&... arguments) : value_(std::forward<Arguments>(arguments)...) {}

    class Locked {
      public:
        Locked(const Locked&) = delete;
        Locked& operator=(const Locked&) = delete;
        ~Locked() {
            if (value_ != nullptr) unlock();
        }
        [[nodiscard]] T* operator->() const { return value_; }
        [[nodiscard]] T& operator*() const { return *value_; }
        // Unlocks before the end of the scope. The value can then no longer be reached through this
        // object.
        void unlock() STORMCELLAR_NO_LOCK_ANALYSIS {  // the constructor has locked the mutex
            value_ = nullptr;
            guarded_.mutex_.unlock();
        }

      private:
        friend class Guarded;
        explicit Locked(Guarded& guarded) : guarded_(guarded) {
            guarded_.mutex_.lock();
            value_ = &guarded_.value_;
        }

        Guarded& guarded_;
        T* value_ = nullptr;
    };

    [[nodiscard]] Locked lock() { return Locked(*this); }

  private:
    Mutex mutex_;
    T value_ STORMCELLAR_GUARDED_BY(mutex_);
};

}  // namespace stormcellar::pipeline
