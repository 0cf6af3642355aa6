// pipeline/ingest/guarded.h -- a value that can be reached only by whoever holds its lock.
//
// Inside the pipeline room only. Thread contract: lock() by any thread; the value by the holder of
// the Locked, which must not outlive the Guarded.
#pragma once

#include <mutex>
#include <utility>

namespace stormcellar::pipeline {

template <class T>
class Guarded {
  public:
    template <class... Arguments>
    explicit Guarded(Arguments&&... arguments) : value_(std::forward<Arguments>(arguments)...) {}

    class Locked {
      public:
        [[nodiscard]] T* operator->() const { return value_; }
        [[nodiscard]] T& operator*() const { return *value_; }
        // Before the end of its scope; the value cannot be reached through it any more.
        void unlock() {
            value_ = nullptr;
            lock_.unlock();
        }

      private:
        friend class Guarded;
        Locked(std::mutex& mutex, T& value) : lock_(mutex), value_(&value) {}

        std::unique_lock<std::mutex> lock_;
        T* value_;
    };

    [[nodiscard]] Locked lock() { return Locked(mutex_, value_); }

  private:
    std::mutex mutex_;
    T value_;
};

}  // namespace stormcellar::pipeline
