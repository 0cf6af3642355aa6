// level2/decode/fragment_builder.h -- collects radials, in the order of the stream, into pieces of
// sweeps.
//
// A piece ends where the elevation number or the message type changes, at a radial with status 0, 3
// or 5, and at a 24-byte header. Codes are copied once, from the message into the arrays.
//
// Memory    A fragment stays within the given room. When it is full, add() and add_pattern() return
//           false and the builder accepts no more.
// Threads   One thread at a time.
#pragma once

#include <cstddef>
#include <cstdint>

#include "level2/decode/array_room.h"
#include "level2/decode/report_writer.h"
#include "level2/messages/radial_message.h"
#include "stormcellar/level2/fragment.h"
#include "stormcellar/level2/selection.h"

namespace stormcellar::level2 {

// Most bytes to which the radials compressed inside messages may expand in one fragment. The limit
// bounds time.
inline constexpr std::uint64_t most_expanded_bytes = std::uint64_t{512} << 20;

// Returns true if the status of the radial begins a sweep: 0, 3 or 5.
[[nodiscard]] bool begins_sweep(const Radial& radial);
// Returns true if the status of the radial ends a sweep: 2 or 4.
[[nodiscard]] bool ends_sweep(const Radial& radial);

// The number of radials in a record of a live volume.
inline constexpr std::size_t rows_of_a_record = 120;

class FragmentBuilder {
  public:
    // The arrays of a piece get room for `expected_rows` radials at first. `room` and `selection`
    // must outlive the builder.
    FragmentBuilder(ArrayRoom& room, std::size_t expected_rows, const Selection& selection)
        : room_(room), expected_rows_(expected_rows), selection_(selection) {}

    // Adds a radial. Returns false if there is not enough room.
    [[nodiscard]] bool add(const RadialMessage& message);
    [[nodiscard]] bool add_pattern(Vcp vcp);
    // Counts the bytes to which a compressed radial expanded. Returns false beyond
    // most_expanded_bytes.
    [[nodiscard]] bool add_expanded(std::uint64_t bytes);
    void further_header(const VolumeHeader& header) { marks_.header = header; }

    // Returns the first station that a radial of the fragment names, or an empty text if no radial
    // names one.
    [[nodiscard]] const std::string& station() const { return fragment_.station; }
    [[nodiscard]] ReportWriter report() { return ReportWriter{fragment_.report}; }
    [[nodiscard]] DecodeReport& report_data() { return fragment_.report; }

    // Returns the fragment, and continues with an empty fragment that takes no room.
    [[nodiscard]] Fragment take();

  private:
    [[nodiscard]] bool begins_sweep_here(const RadialMessage& message) const;
    [[nodiscard]] bool begin_piece(const RadialMessage& message);
    void note_volume_facts(const RadialMessage& message);
    void reserve_rows(Sweep& sweep) const;
    [[nodiscard]] bool add_rows(Sweep& sweep, const RadialMessage& message);
    [[nodiscard]] bool add_moment(Sweep& sweep, const MomentBlock& block);

    ArrayRoom& room_;
    std::size_t expected_rows_;
    const Selection& selection_;
    Fragment fragment_;
    std::uint64_t errors_at_last_radial_ = 0;
    // facts since the last piece began; they apply to later sweeps
    FragmentMarks marks_;
};

}  // namespace stormcellar::level2
