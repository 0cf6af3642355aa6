// level2/fragment_builder.h -- puts radials, in the order of the stream, into pieces of sweeps.
//
// A piece ends where the elevation number or the message type changes, where a radial has status
// 0, 3 or 5, and at a 24-byte header. Codes are copied once, from the message into the arrays.
// Memory: the arrays of a fragment stay under the limit given; add() then says so and the builder
// takes no more. A piece holds at most 16 kinds of a moment (which differ in gates, scale or word
// size): radials with yet another one are refused.
#pragma once

#include <cstdint>

#include "level2/fragment.h"
#include "level2/radial_message.h"
#include "level2/report_writer.h"
#include "level2/selection.h"

namespace stormcellar::level2 {

// Real sweeps hold one or two kinds of a moment.
inline constexpr std::ptrdiff_t most_kinds_of_a_moment = 16;

// Whether the radial's status begins a sweep: 0, 3 or 5.
[[nodiscard]] bool begins_sweep(const Radial& radial);
// Whether it ends one: 2 or 4.
[[nodiscard]] bool ends_sweep(const Radial& radial);

class FragmentBuilder {
  public:
    // `expected_rows`: radials of a piece, to make room for.
    FragmentBuilder(std::uint64_t limit_bytes, std::size_t expected_rows,
                    const Selection& selection)
        : limit_bytes_(limit_bytes), expected_rows_(expected_rows), selection_(selection) {}

    enum class Added : std::uint8_t { added, refused, full };
    [[nodiscard]] Added add(const RadialMessage& message);
    void add_pattern(Vcp vcp) { marks_.patterns.push_back(std::move(vcp)); }
    void further_header(const VolumeHeader& header) { marks_.header = header; }

    [[nodiscard]] ReportWriter report() { return ReportWriter{fragment_.report}; }
    [[nodiscard]] DecodeReport& report_data() { return fragment_.report; }

    // Gives up what there is; the builder goes on with an empty fragment.
    [[nodiscard]] Fragment take();

  private:
    [[nodiscard]] bool begins_piece(const RadialMessage& message) const;
    void begin_piece(const RadialMessage& message);
    void note_volume_facts(const RadialMessage& message);
    void make_room(Sweep& sweep) const;
    [[nodiscard]] Added add_rows(Sweep& sweep, const RadialMessage& message);
    [[nodiscard]] bool add_moment(Sweep& sweep, const MomentBlock& block);
    [[nodiscard]] bool has_too_many_kinds(const Sweep& sweep, const RadialMessage& message) const;
    [[nodiscard]] bool take_room(std::uint64_t bytes);

    std::uint64_t limit_bytes_;
    std::size_t expected_rows_;
    const Selection& selection_;
    std::uint64_t taken_bytes_ = 0;
    Fragment fragment_;
    // Since the last piece began; a pattern in the midst of a sweep holds for those to come.
    FragmentMarks marks_;
};

}  // namespace stormcellar::level2
