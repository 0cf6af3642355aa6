// tests/hard_cases/message_mutants.h -- damages the message stream, which no checksum guards.
#pragma once

#include <random>

#include "tests/hard_cases/mutant.h"
#include "tests/hard_cases/unpacked_volume.h"

namespace stormcellar::level2 {

// Makes numbered mutants of a plain stream. The kinds of damage alternate with the number, and the
// number decides the rest. Every 16th mutant is packed into one LDM record.
class MessageMutants {
  public:
    explicit MessageMutants(const UnpackedVolume& volume) : volume_(volume) {}
    [[nodiscard]] Mutant make(std::uint64_t number) const;

  private:
    using Random = std::mt19937_64;
    // The messages of the stream, and the fate of each.
    struct Draft {
        Mutant mutant;
        std::vector<wire::Bytes> parts;
        std::vector<std::size_t> order;  // numbers of the messages in the order of the file
        std::vector<Fate> fates;         // by number of the message
        bool is_put_right = false;       // late or repeated radials return to their places
    };
    void field(Draft& draft, Random& random) const;
    void block_field(Draft& draft, Random& random) const;
    void rearranged(Draft& draft, Random& random) const;
    void resized(Draft& draft, Random& random) const;
    void flipped(Draft& draft, Random& random) const;
    void overwritten(Draft& draft, Random& random) const;
    void cut(Draft& draft, Random& random) const;
    void several(Draft& draft, Random& random) const;

    [[nodiscard]] Draft draft() const;
    [[nodiscard]] std::uint32_t elevation_number(std::size_t number) const;
    [[nodiscard]] bool is_of_one_volume(std::size_t first_message, std::size_t last_message) const;
    [[nodiscard]] std::size_t any_message(Random& random) const;
    [[nodiscard]] Mutant finish(Draft draft, std::uint64_t number) const;

    const UnpackedVolume& volume_;
};

}  // namespace stormcellar::level2
