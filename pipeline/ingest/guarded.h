// pipeline/ingest/guarded.h -- a value that only the holder of its lock can reach.
//
// Inside the pipeline room only. Thread contract: any thread may call lock(); the holder of the
// Locked uses the value. A Locked must not outlive its Guarded.
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
        // Unlocks before the end of the scope; the value can then no longer be reached through this
        // object.
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
