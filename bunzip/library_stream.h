// bunzip/library_stream.h -- reads a stream with libbz2, for Path::libbz2 and for randomized
// blocks.
//
// Threads   One thread at a time.
#pragma once

#include <cstddef>
#include <memory>
#include <span>

#include "bunzip/bunzip.h"

namespace stormcellar::bunzip {

class LibraryStream {
  public:
    explicit LibraryStream(std::span<const std::byte> stream);
    ~LibraryStream();
    LibraryStream(const LibraryStream&) = delete;
    LibraryStream& operator=(const LibraryStream&) = delete;

    [[nodiscard]] std::size_t read(std::span<std::byte> out);
    [[nodiscard]] bool ended() const { return ended_; }
    [[nodiscard]] Status status() const { return status_; }
    [[nodiscard]] std::size_t input_bytes() const;

  private:
    struct State;
    std::span<const std::byte> stream_;
    std::unique_ptr<State> state_;
    bool ended_ = false;
    Status status_ = Status::whole;
};

}  // namespace stormcellar::bunzip
