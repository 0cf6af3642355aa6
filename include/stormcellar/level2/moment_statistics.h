// stormcellar/level2/moment_statistics.h -- counts the gates of one moment of a sweep by state and
// code.
//
// Units     Values are in the unit of the moment.
// Threads   Plain data and a pure function.
// Errors    None.
// Accuracy  Counts and the checksum are exact. The mean comes from exact counts, in double.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "stormcellar/level2/volume.h"

namespace stormcellar::level2 {

struct MomentStatistics {
    std::uint64_t radials = 0;  // radials that have the moment
    std::uint16_t gates_first = 0;
    std::uint16_t gates_min = 0;
    std::uint16_t gates_max = 0;
    std::uint64_t codes = 0;
    std::uint64_t code_0 = 0;
    std::uint64_t code_1 = 0;
    std::uint64_t code_2_to_7 = 0;  // flags in CFP, values elsewhere
    std::uint64_t valid = 0;
    // min, max and mean of the valid values; none if there are no valid values
    std::optional<double> min;
    std::optional<double> max;
    std::optional<double> mean;
    std::uint32_t crc32 = 0;  // of all codes, radial by radial; 16-bit codes are big-endian
    const SweepMoment* first = nullptr;  // the SweepMoment of the first radial with the moment
    bool geometry_constant = true;
    bool scale_constant = true;
};

// Counts all SweepMoments of the moment together. Returns none if the sweep lacks the moment.
[[nodiscard]] std::optional<MomentStatistics> moment_statistics(const Sweep& sweep, Moment moment);

}  // namespace stormcellar::level2
