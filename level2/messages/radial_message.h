// level2/messages/radial_message.h -- reads one radial from message 31 or from the old message 1.
//
// The codes are views into the message, so a RadialMessage must not outlive the message's bytes.
// The readers check every length, pointer and count against the message and against the neighboring
// blocks. Every angle is finite.
//
// Threads   Plain values and pure functions.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include <tl/expected.hpp>

#include "stormcellar/level2/volume.h"

namespace stormcellar::level2 {

struct MomentBlock {
    Moment moment = Moment::ref;
    std::int32_t first_gate_m = 0;
    std::int32_t gate_spacing_m = 0;
    std::uint16_t gates = 0;  // at least 1
    int word_size_bits = 8;   // 8 or 16
    float scale = 1;
    float offset = 0;
    int control_flags = -1;
    float snr_threshold_db = 0;
    float folding_threshold_db = 0;
    std::span<const std::byte> codes;  // gates * word size, big-endian
};

struct RadialMessage {
    static constexpr std::size_t max_moments = 16;

    Radial radial;
    int message_type = 31;
    int elevation_number = 0;
    float azimuth_spacing_deg = 0;
    std::string_view icao;                    // from message 31, unchanged
    std::optional<std::uint16_t> vcp;         // none if the message does not give it
    std::span<const std::byte> volume_block;  // from "RVOL" to the next block; empty if absent
    int unknown_blocks = 0;                   // blocks with an unknown name, which were skipped

    // A moment in the message whose gates cannot be read.
    struct LostMoment {
        std::string_view reason;
        std::size_t bytes = 0;
    };
    // Both are empty in a radial that follows the ICD.
    std::vector<LostMoment> lost_moments;
    std::vector<std::string_view> oddities;  // faults that lose no gate, each in a few words

    [[nodiscard]] std::span<const MomentBlock> moments() const {
        return {moment_store.data(), moment_count};
    }
    // Returns true if the radial has lost all moments of its message, and at least one.
    [[nodiscard]] bool has_lost_all() const { return moment_count == 0 && !lost_moments.empty(); }
    // Adds a moment. Returns false and does nothing if there is no room or the radial already has
    // it.
    bool add(const MomentBlock& block);

    std::array<MomentBlock, max_moments> moment_store;
    std::size_t moment_count = 0;
};

// The reason, in a few words, why a message holds no usable radial.
using RadialResult = tl::expected<RadialMessage, std::string_view>;

// The framing of a message is proven if the bytes around the message show where it begins and ends.
// If it is unproven, a fault in any block may mean that the message has lost bytes.
enum class Framing : std::uint8_t { unproven, proven };

// Read a radial. `body` is the message after its 28 bytes of header. With unproven framing, the
// functions refuse the whole radial at the first fault in a block, and lost_moments stays empty.
[[nodiscard]] RadialResult read_message_1(std::span<const std::byte> body,
                                          Framing framing = Framing::unproven);
[[nodiscard]] RadialResult read_message_31(std::span<const std::byte> body,
                                           Framing framing = Framing::unproven);

// Reads the volume data block, from its "RVOL" on. Returns none if it is too short.
[[nodiscard]] std::optional<VolumeBlock> read_volume_block(std::span<const std::byte> block);

// Convert codes in units of 180/32768 degree, as in messages 1 and 5, to degrees. Elevations above
// 180 are returned as negative angles.
[[nodiscard]] float elevation_from_code(std::uint16_t code);
[[nodiscard]] float azimuth_from_code(std::uint16_t code);

}  // namespace stormcellar::level2
