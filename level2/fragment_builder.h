// level2/fragment_builder.h -- puts radials, in the order of the stream, into pieces of sweeps.
//
// A piece ends where the elevation number or the message type changes, where a radial has status
// 0, 3 or 5, and at a 24-byte header. Codes are copied once, from the message into the arrays.
// Memory: what a fragment holds stays in the room given; add() and add_pattern() then say so and
// the builder takes no more. A piece holds at most 16 kinds of a moment (which differ in gates,
// scale or word size): a radial with yet another one begins another piece of the same sweep.
#pragma once

#include <cstdint>

#include "level2/array_room.h"
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
    // `expected_rows`: radials of a piece, to make room for. The room and the selection must
    // outlive the builder.
    FragmentBuilder(ArrayRoom& room, std::size_t expected_rows, const Selection& selection)
        : room_(room), expected_rows_(expected_rows), selection_(selection) {}

    // False: the room does not suffice.
    [[nodiscard]] bool add(const RadialMessage& message);
    [[nodiscard]] bool add_pattern(Vcp vcp);
    void further_header(const VolumeHeader& header) { marks_.header = header; }

    [[nodiscard]] ReportWriter report() { return ReportWriter{fragment_.report}; }
    [[nodiscard]] DecodeReport& report_data() { return fragment_.report; }

    // Gives up what there is; the builder goes on with an empty fragment, and nothing is taken of
    // its room.
    [[nodiscard]] Fragment take();

  private:
    [[nodiscard]] bool begins_sweep_here(const RadialMessage& message) const;
    void begin_piece(const RadialMessage& message);
    void note_volume_facts(const RadialMessage& message);
    void reserve_rows(Sweep& sweep) const;
    [[nodiscard]] bool add_rows(Sweep& sweep, const RadialMessage& message);
    [[nodiscard]] bool add_moment(Sweep& sweep, const MomentBlock& block);
    [[nodiscard]] bool has_too_many_kinds(const Sweep& sweep, const RadialMessage& message) const;

    ArrayRoom& room_;
    std::size_t expected_rows_;
    const Selection& selection_;
    Fragment fragment_;
    // Since the last piece began; a pattern in the midst of a sweep holds for those to come.
    FragmentMarks marks_;
};

}  // namespace stormcellar::level2
