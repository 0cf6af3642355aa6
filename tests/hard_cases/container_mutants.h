// tests/hard_cases/container_mutants.h -- damages LDM records, and the gzip layer around a file.
#pragma once

#include <random>

#include "tests/hard_cases/mutant.h"
#include "tests/hard_cases/unpacked_volume.h"

namespace stormcellar::level2 {

// Makes numbered mutants of a volume in LDM records. The kinds of damage alternate with the number,
// and the number decides the rest, so a number gives the same mutant on every machine.
class ContainerMutants {
  public:
    explicit ContainerMutants(const UnpackedVolume& volume) : volume_(volume) {}
    [[nodiscard]] Mutant make(std::uint64_t number) const;

  private:
    using Random = std::mt19937_64;
    [[nodiscard]] Mutant control_word(Random& random) const;
    [[nodiscard]] Mutant rearranged(Random& random) const;
    [[nodiscard]] Mutant cut(Random& random) const;
    [[nodiscard]] Mutant flipped(Random& random) const;
    [[nodiscard]] Mutant resized(Random& random) const;
    [[nodiscard]] Mutant overwritten(Random& random) const;
    [[nodiscard]] Mutant gzip(Random& random) const;

    // Returns the radials to expect from these records in this order. Radials of record `soft` may
    // be lost.
    [[nodiscard]] std::vector<ExpectedRadial> expect(const std::vector<std::size_t>& order,
                                                     std::optional<std::size_t> soft) const;
    [[nodiscard]] std::vector<std::size_t> all_records() const;
    [[nodiscard]] Mutant with_record(std::string kind, std::size_t record,
                                     const wire::Bytes& bytes) const;

    const UnpackedVolume& volume_;
};

// Flips a bit of a gzip file that holds messages without records, or cuts the file.
[[nodiscard]] Mutant gzip_mutant(const UnpackedVolume& volume, std::uint64_t number);

}  // namespace stormcellar::level2
