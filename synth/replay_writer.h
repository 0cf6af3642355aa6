// synth/replay_writer.h -- writes pieces into files as LDM's pqact does.
//
// Threads   One thread at a time.
// Errors    io, with the path and the system's reason.
#pragma once

#include <cstddef>
#include <filesystem>
#include <list>
#include <span>
#include <utility>

#include "stormcellar/base/result.h"

namespace stormcellar::synth {

class PieceWriter {
  public:
    // Up to `most_open` files stay open after append(). If it is 0, each file is closed at once.
    explicit PieceWriter(std::size_t most_open) : most_open_(most_open) {}
    PieceWriter(const PieceWriter&) = delete;
    PieceWriter& operator=(const PieceWriter&) = delete;
    ~PieceWriter();

    // Appends to a file. Makes the file if it does not exist.
    [[nodiscard]] Status append(const std::filesystem::path& path,
                                std::span<const std::byte> bytes);
    // Writes a file that holds only these bytes, and closes it.
    [[nodiscard]] Status put(const std::filesystem::path& path, std::span<const std::byte> bytes);
    // Closes all open files.
    [[nodiscard]] Status close();

  private:
    [[nodiscard]] Status close_oldest();

    std::size_t most_open_;
    // The last one is the file written last.
    std::list<std::pair<std::filesystem::path, int>> open_;
};

}  // namespace stormcellar::synth
