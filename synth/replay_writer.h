// synth/replay_writer.h -- writes pieces into files as LDM's pqact does.
//
// Errors: io with the path and the system's reason.
// Threads: one.
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
    // So many files stay open behind append(); 0: each is closed at once.
    explicit PieceWriter(std::size_t most_open) : most_open_(most_open) {}
    PieceWriter(const PieceWriter&) = delete;
    PieceWriter& operator=(const PieceWriter&) = delete;
    ~PieceWriter();

    // Makes the file where there is none.
    [[nodiscard]] Status append(const std::filesystem::path& path,
                                std::span<const std::byte> bytes);
    // The file holds these bytes and nothing else, and is closed.
    [[nodiscard]] Status put(const std::filesystem::path& path, std::span<const std::byte> bytes);
    // Closes all that are open.
    [[nodiscard]] Status close();

  private:
    [[nodiscard]] Status close_oldest();

    std::size_t most_open_;
    std::list<std::pair<std::filesystem::path, int>> open_;  // written last at the end
};

}  // namespace stormcellar::synth
