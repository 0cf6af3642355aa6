// stormcellar/level2/moment_statistics.h -- what the gates of one moment of a sweep hold, counted.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "stormcellar/level2/volume.h"

namespace stormcellar::level2 {

struct MomentStatistics {
    std::uint64_t radials = 0;  // that have the moment
    std::uint16_t gates_first = 0;
    std::uint16_t gates_min = 0;
    std::uint16_t gates_max = 0;
    std::uint64_t codes = 0;
    std::uint64_t code_0 = 0;
    std::uint64_t code_1 = 0;
    std::uint64_t code_2_to_7 = 0;  // flags in CFP, values elsewhere
    std::uint64_t valid = 0;
    std::optional<double> min;  // of the valid values; none without any
    std::optional<double> max;
    std::optional<double> mean;
    std::uint32_t crc32 = 0;  // of the codes, 16-bit ones big-endian, radials in file order
    const SweepMoment* first = nullptr;  // the kind that the first radial with the moment has
    bool geometry_constant = true;
    bool scale_constant = true;
};

// All kinds of the moment together; none when the sweep lacks it.
[[nodiscard]] std::optional<MomentStatistics> moment_statistics(const Sweep& sweep, Moment moment);

}  // namespace stormcellar::level2
