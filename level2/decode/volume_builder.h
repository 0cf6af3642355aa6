// level2/decode/volume_builder.h -- joins fragments, in the order of the stream, into a volume.
//
// A sweep continues in the next fragment unless the elevation number or the message type changes, a
// radial has status 0, 3 or 5, or there is a 24-byte header in between.
//
// Records may come in another order than the radar sent them, for example in a file to which LDM
// appends. The builder puts a radial that is older than the previous radial into the gap in its
// sweep, and drops a repeated radial. So the volume is the same as from records in the right order.
// A further volume begins at a radial marked as a start, after a further header, or where the
// elevation number falls while time goes forward.
//
// Limits    Neither the decompressed bytes nor the arrays exceed the given limits. If append()
//           returns an error (unsupported beyond a limit), the builder must not be used any more.
//           The arrays of one sweep do not exceed most_sweep_bytes.
// Threads   One thread at a time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "level2/decode/array_room.h"
#include "level2/decode/late_radials.h"
#include "level2/decode/report_writer.h"
#include "stormcellar/level2/decoded.h"
#include "stormcellar/level2/fragment.h"

namespace stormcellar::level2 {

// Messages that are not in LDM records are read in stretches of this size, so that memory holds few
// of them.
inline constexpr std::size_t stretch_bytes = std::size_t{1} << 20;
// Largest number of searches for the places of late radials in a file. Real files need fewer in any
// order of their records; the limit keeps a hostile file from taking much time.
inline constexpr std::size_t most_late_searches = 500;
inline constexpr std::size_t rows_of_a_stretch = 128;  // rows reserved for a piece in a stretch

// Returns true if a piece continues the sweep of the previous piece, provided that no header is
// between them.
[[nodiscard]] bool continues_sweep(const Fragment::Piece& previous, const Fragment::Piece& piece);

class VolumeBuilder {
  public:
    explicit VolumeBuilder(std::uint64_t limit_bytes) : VolumeBuilder(limit_bytes, limit_bytes) {}
    // Makes a builder with a separate limit for the arrays.
    VolumeBuilder(std::uint64_t limit_bytes, std::uint64_t array_limit_bytes)
        : limit_bytes_(limit_bytes),
          array_limit_bytes_(array_limit_bytes),
          room_(array_limit_bytes) {}

    [[nodiscard]] Status append(Fragment fragment);
    // Takes station, position and pattern from the fragment, but no radials.
    void note_facts(const Fragment& fragment);
    // Counts decompressed bytes that are not counted in a fragment. Errors: unsupported beyond the
    // limit.
    [[nodiscard]] Status count_output(std::uint64_t bytes);
    [[nodiscard]] Status too_much_output() const;
    [[nodiscard]] std::uint64_t output_left() const { return limit_bytes_ - output_bytes_; }
    // Counts memory other than arrays that is held until the end. Errors: unsupported beyond the
    // limit.
    [[nodiscard]] Status hold(std::uint64_t bytes);
    // Returns how many bytes the arrays of the next fragment may take.
    [[nodiscard]] std::uint64_t arrays_left() const { return room_.left_bytes(); }
    // Takes the volume header from the start of a stream of messages or LDM records, and returns
    // the bytes after the header. Returns all bytes if there is no header.
    [[nodiscard]] std::span<const std::byte> begin_stream(std::span<const std::byte> bytes);
    void set_header(VolumeHeader header) { volume_.header = std::move(header); }

    [[nodiscard]] ReportWriter report() { return ReportWriter{report_}; }
    [[nodiscard]] DecodeReport& report_data() { return report_; }
    void set_cut() { cut_ = true; }  // the input ends too early
    [[nodiscard]] bool is_cut() const { return cut_; }
    // Marks the volume as damaged.
    void set_incomplete() { incomplete_ = true; }
    // Returns the volume up to now. The last sweep may continue; its moments may lack rows or have
    // rows that are too long.
    [[nodiscard]] const Volume& so_far() const { return volume_; }
    [[nodiscard]] bool so_far_holds_one() const { return report_.further_volume_starts.empty(); }
    // Returns a copy of a sweep of so_far() with complete rows.
    [[nodiscard]] Sweep whole_sweep(std::size_t index) const;
    // Returns the number of sweeps that later radials have closed.
    [[nodiscard]] std::size_t closed_sweeps() const;
    // Frees the arrays of a closed sweep that is not the last sweep. The caller must put an equal
    // sweep back before finish().
    void drop_sweep(std::size_t index);
    // Sets the function that returns a dropped sweep. append() calls it to search the sweep for the
    // place of late radials.
    using DroppedSweeps = std::function<Result<Sweep>(std::size_t)>;
    void set_dropped_sweeps(DroppedSweeps dropped) { dropped_ = std::move(dropped); }
    // Returns the closed sweeps that got late radials since the last call, and the dropped sweeps
    // that were fetched back but not changed.
    struct Touched {
        std::set<std::size_t> changed, fetched;
    };
    [[nodiscard]] Touched take_touched() { return std::exchange(touched_, {}); }
    // Puts a dropped sweep back. Does nothing if the sweep is not dropped.
    void put_back(std::size_t index, Sweep sweep);
    // Returns the bytes of the arrays of all sweeps that were not dropped.
    [[nodiscard]] std::uint64_t held_bytes() const;
    // Returns the part of held_bytes() that the open sweep takes.
    [[nodiscard]] std::uint64_t open_sweep_bytes() const;
    // Returns true if the status of the newest radial ends the open sweep. More radials may still
    // follow.
    [[nodiscard]] bool last_has_ended() const { return sweep_is_open_ && previous_->ended_sweep; }
    [[nodiscard]] bool has_radials() const { return previous_.has_value(); }
    // Returns everything but the sweeps.
    [[nodiscard]] Volume facts(const std::string& fallback_station) const;
    [[nodiscard]] bool volume_has_ended() const { return previous_ && previous_->end_of_volume; }

    // Returns the volume with its report, which lists missing parts and contradictions. The builder
    // must not be used afterward. If the file does not name its station, the fallback is the
    // station. Errors: truncated or corrupt if neither a radial nor metadata is whole.
    [[nodiscard]] Result<Decoded> finish(const std::string& fallback_station);

  private:
    // Facts of the newest piece, even if its cut is not selected.
    struct Previous {
        int elevation_number = 0;
        int message_type = 0;
        bool ended_sweep = false;  // its last radial had status 2 or 4
        // The time of the last radial of the volume (status 4), if it has come and no newer radial
        // has come.
        std::optional<UtcTime> end_of_volume;
        UtcTime time;
        std::uint16_t azimuth_number = 0;
    };
    // The place of late radials: the next late radial goes before radial number `at` of the sweep.
    struct LatePlace {
        std::size_t sweep = 0;
        std::size_t at = 0;
    };
    [[nodiscard]] std::string station(const std::string& fallback) const;
    [[nodiscard]] bool append_all(Fragment& fragment);
    [[nodiscard]] bool note_marks(FragmentMarks marks);
    void note_header(VolumeHeader header);
    void set_pattern(Vcp vcp);
    [[nodiscard]] std::optional<float> elevation_of_cut(const Sweep& sweep) const;
    void note_volume_facts(const Fragment& fragment);
    void count_errors(const Fragment& fragment);
    [[nodiscard]] bool append_piece(Fragment::Piece piece);
    [[nodiscard]] bool append_in_order(Fragment::Piece piece);
    [[nodiscard]] bool is_late(const Sweep& sweep, std::size_t radial) const;
    [[nodiscard]] bool header_is_repeated() const;
    [[nodiscard]] Status fetch_back(std::size_t index);
    [[nodiscard]] bool may_follow_late(const Sweep& from, std::size_t radial) const;
    [[nodiscard]] LateFit fit_of_late(const Radial& radial, const Radial* before) const;
    [[nodiscard]] Result<bool> find_late_place(const Sweep& from, std::size_t radial);
    // Takes the late radials from `first` on, and returns the index after the last one.
    [[nodiscard]] Result<std::size_t> take_late(Sweep& from, std::size_t first);
    [[nodiscard]] Status insert_late(Sweep& from, std::size_t first, std::size_t end);
    void put_sweeps_in_order();
    void report_late();
    [[nodiscard]] bool begins_sweep_here(const Fragment::Piece& piece) const;
    [[nodiscard]] bool begins_volume(const Fragment::Piece& piece) const;
    [[nodiscard]] bool begin_volume(const Fragment::Piece& piece);
    [[nodiscard]] DecodeReport::FurtherPattern pattern_of(const Fragment::Piece& piece);
    [[nodiscard]] Sweep& begin_sweep(const Sweep& from);
    void end_sweep();
    void tidy_last_sweep();
    [[nodiscard]] bool make_room_for(const Sweep& sweep, const Sweep& from);
    void append_rows(Sweep& sweep, const Sweep& from);

    std::uint64_t limit_bytes_, array_limit_bytes_;
    ArrayRoom room_;
    std::uint64_t output_bytes_ = 0;
    bool cut_ = false;
    bool incomplete_ = false;
    std::uint64_t errors_within_ = 0;  // errors before the last radial
    std::uint64_t errors_behind_ = 0;
    Volume volume_;
    DecodeReport report_;
    std::optional<Previous> previous_;
    bool sweep_is_open_ = false;  // the last sweep of volume_ belongs to the newest piece
    std::optional<Vcp> current_vcp_;
    bool vcp_is_new_ = false;  // current_vcp_ came after the newest sweep began
    std::optional<VolumeHeader> pending_header_;
    std::optional<UtcTime> first_time_;  // of the first radial
    // True if the header of the first volume came after radials of that volume.
    bool header_is_late_ = false;
    bool start_has_come_ = false;  // the newest volume has a radial that is marked as its first
    std::optional<LatePlace> late_place_;
    std::size_t late_searches_ = 0;
    std::uint64_t late_bytes_ = 0;  // bytes moved to insert late radials
    std::uint64_t late_radials_ = 0, repeated_radials_ = 0;
    bool is_disordered_ = false;  // a sweep is older than the sweep before it
    Status late_failure_;
    DroppedSweeps dropped_;
    Touched touched_;
};

}  // namespace stormcellar::level2
