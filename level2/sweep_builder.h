// level2/sweep_builder.h -- puts radials, in the order of the file, into sweeps.
//
// A new sweep begins where the elevation number or the message type changes, or a radial has
// status 0, 3 or 5. Codes are copied once, from the message into the sweep's arrays.
// Memory: all arrays together stay under the limit given; add() then says so and the builder takes
// no more. A sweep holds at most 16 kinds of a moment (which differ in gates, scale or word size):
// radials with yet another one are refused.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "level2/decode.h"
#include "level2/radial_message.h"

namespace stormcellar::level2 {

class SweepBuilder {
  public:
    explicit SweepBuilder(std::uint64_t limit_bytes) : limit_bytes_(limit_bytes) {}

    enum class Added : std::uint8_t { added, refused, full };
    [[nodiscard]] Added add(const RadialMessage& message);
    // The pattern in force for sweeps that begin from now on; the first is the volume's.
    void set_vcp(Vcp vcp);
    // A 24-byte header inside the stream: what follows is another volume if radials came before.
    void further_header(const VolumeHeader& header);

    // Gives up the volume without its header; fills in the report's volume starts, station and
    // completeness. The builder is empty afterwards.
    [[nodiscard]] Volume finish(DecodeReport& report);

  private:
    void begin_sweep(const RadialMessage& message);
    void end_sweep();
    [[nodiscard]] bool begins_volume(const RadialMessage& message) const;
    [[nodiscard]] bool add_moment(Sweep& sweep, const MomentBlock& block);
    [[nodiscard]] static SweepMoment* find_kind(Sweep& sweep, const MomentBlock& block);
    [[nodiscard]] static SweepMoment& begin_kind(Sweep& sweep, const MomentBlock& block);
    [[nodiscard]] static bool has_too_many_kinds(const Sweep& sweep, const RadialMessage& message);
    [[nodiscard]] static std::uint64_t row_bytes(const Sweep& sweep);
    [[nodiscard]] DecodeReport::FurtherPattern pattern_of(const RadialMessage& message);
    void note_station(const RadialMessage& message);
    [[nodiscard]] bool take(std::uint64_t bytes);

    std::uint64_t limit_bytes_;
    std::uint64_t taken_bytes_ = 0;
    Volume volume_;
    std::string message_station_;
    std::optional<Vcp> current_vcp_;
    bool vcp_is_new_ = false;  // came after the newest sweep began
    std::vector<DecodeReport::FurtherPattern> further_patterns_;
    std::optional<VolumeHeader> pending_header_;
    std::vector<std::size_t> volume_starts_;
    std::vector<DecodeReport::FurtherHeader> further_headers_;
    bool volume_ended_ = false;  // the last radial had status 4
};

}  // namespace stormcellar::level2
