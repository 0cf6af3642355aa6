// stormcellar/base/descriptor.h -- owns a file descriptor and closes it when destroyed.
//
// A negative number means that there is no descriptor. AT_FDCWD is negative, so it is never closed.
//
// Threads   A Descriptor may be used by one thread at a time.
// Errors    None; a failure of close() is ignored.
#pragma once

#include <utility>

#include <unistd.h>

namespace stormcellar {

class Descriptor {
  public:
    Descriptor() = default;
    explicit Descriptor(int number) : number_(number) {}
    Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
    Descriptor& operator=(Descriptor&& other) noexcept {
        std::swap(number_, other.number_);
        return *this;
    }
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    ~Descriptor() {
        if (number_ >= 0) ::close(number_);
    }
    [[nodiscard]] int number() const { return number_; }
    [[nodiscard]] bool is_open() const { return number_ >= 0; }
    // Gives the descriptor to the caller, who must close it.
    [[nodiscard]] int release() { return std::exchange(number_, -1); }

  private:
    int number_ = -1;
};

}  // namespace stormcellar
