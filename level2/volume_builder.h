// level2/volume_builder.h -- joins fragments, in the order of the stream, into a volume.
//
// A sweep goes on in the next fragment unless the elevation number or the message type changes, a
// radial has status 0, 3 or 5, or a 24-byte header lies between. Memory: the arrays stay under the
// limit given; append() then says so and the builder takes no more.
// Thread contract: one thread at a time.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "level2/decode.h"
#include "level2/fragment.h"
#include "level2/report_writer.h"

namespace stormcellar::level2 {

class VolumeBuilder {
  public:
    explicit VolumeBuilder(std::uint64_t limit_bytes) : limit_bytes_(limit_bytes) {}

    // False when the arrays would exceed the limit.
    [[nodiscard]] bool append(Fragment fragment);
    void set_header(VolumeHeader header) { volume_.header = std::move(header); }

    [[nodiscard]] ReportWriter report() { return ReportWriter{report_}; }
    [[nodiscard]] DecodeReport& report_data() { return report_; }
    // What there is up to now; the last sweep may go on.
    [[nodiscard]] const Volume& so_far() const { return volume_; }

    // Gives up the volume, checked: what it lacks and where it contradicts itself is in the report.
    // The station is the fallback where the file does not say.
    [[nodiscard]] Decoded finish(const std::string& fallback_station);

  private:
    // Of the newest piece, also of one that is left out.
    struct Previous {
        int elevation_number = 0;
        int message_type = 0;
        bool ended_volume = false;  // its last radial had status 4
    };
    void note_marks(FragmentMarks marks);
    void set_pattern(Vcp vcp);
    void note_volume_facts(Fragment& fragment);
    [[nodiscard]] bool append_piece(Fragment::Piece piece);
    [[nodiscard]] bool begins_sweep_here(const Fragment::Piece& piece) const;
    [[nodiscard]] bool begins_volume(const Fragment::Piece& piece) const;
    void begin_volume(const Fragment::Piece& piece);
    [[nodiscard]] DecodeReport::FurtherPattern pattern_of(const Fragment::Piece& piece);
    [[nodiscard]] Sweep& begin_sweep(const Sweep& from);
    void end_sweep();
    void refuse_surplus_kinds(const Sweep& sweep, Sweep& from);
    [[nodiscard]] bool append_rows(Sweep& sweep, const Sweep& from);
    [[nodiscard]] bool append_moment(Sweep& sweep, std::size_t radials_before,
                                     const SweepMoment& from);
    [[nodiscard]] bool take_room(std::uint64_t bytes);

    std::uint64_t limit_bytes_;
    std::uint64_t taken_bytes_ = 0;
    Volume volume_;
    DecodeReport report_;
    std::optional<Previous> previous_;
    bool sweep_is_open_ = false;  // the last sweep of volume_ belongs to the newest piece
    std::optional<Vcp> current_vcp_;
    bool vcp_is_new_ = false;  // came after the newest sweep began
    std::optional<VolumeHeader> pending_header_;
};

}  // namespace stormcellar::level2
