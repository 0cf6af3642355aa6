#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>
#include <utility>

#include "retrieve/cells/cell_matching.h"
#include "retrieve/cells/track_motion.h"
#include "stormcellar/retrieve/storm_cells.h"

namespace stormcellar::retrieve {
namespace {

// Added in quadrature to the error of a motion that becomes a prior because its cell split or
// merged. The position of such a cell jumps, but that jump is not part of the motion.
constexpr double inherited_error_mps = 3;
// The search radius (gate) around a predicted place: gate_m, plus gate_mps (fastest_mps if no
// motion is known) for each second since the last sighting; at most farthest_gate_m.
constexpr double gate_m = 5'000, gate_mps = 5, farthest_gate_m = 15'000;

struct CellTrack {
    std::string id;
    std::vector<CellSighting> sightings;
    std::size_t fit_from = 0;  // first sighting of the fitted line (last split or merger)
    const StormCell* cell = nullptr;
    const grid::GridSpec* spec = nullptr;
    std::optional<TrackMotion> prior, motion;
    bool has_inherited = false;  // the prior is a motion from before a split or merger
    bool is_open = true;
};

class Tracker {
  public:
    explicit Tracker(const TrackOptions& options) : options_(options) {}

    TrackedScan add(const CellScan& scan) {
        close_old_tracks(scan.time);
        open_.clear();
        for (std::size_t i = 0; i < tracks_.size(); ++i)
            if (tracks_[i].is_open) open_.push_back(i);
        const std::vector<ExpectedCell> expected = expect_cells(scan);
        const CellMatches matches = match_cells(expected, scan);
        TrackedScan tracked{scan.time, scan.area, {}, scan.freezing};
        std::vector<std::size_t> track_of(scan.cells.size());
        for (std::size_t j = 0; j < scan.cells.size(); ++j) {
            TrackedCell cell;
            cell.cell = scan.cells[j];
            cell.time = scan.time;
            if (const auto i = matches.expected_of[j])
                track_of[j] = continue_track(open_[*i], scan, j, cell);
            else
                track_of[j] = begin_track(scan, j, matches, cell);
            tracked.cells.push_back(std::move(cell));
        }
        name_merged(matches, tracked, track_of);
        for (std::size_t j = 0; j < scan.cells.size(); ++j)
            finish(tracks_[track_of[j]], tracked.cells[j]);
        last_time_ = scan.time;
        return tracked;
    }

  private:
    void close_old_tracks(UtcTime now) {
        for (CellTrack& track : tracks_) {
            if (seconds_between(track.sightings.back().time, now) > options_.longest_gap_s)
                track.is_open = false;
        }
    }

    // Returns the motion of the echo at the nearest cell for which it is known.
    [[nodiscard]] static std::optional<Motion> echo_motion_near(const CellScan& scan,
                                                                grid::GeoPoint place) {
        const grid::SiteFrame frame(place.latitude_deg, place.longitude_deg);
        std::optional<Motion> nearest;
        double nearest_m = 0;
        for (const StormCell& cell : scan.cells) {
            if (!cell.echo_motion) continue;
            const double arc_m = frame.to_polar(cell.position).arc_m;
            if (!nearest || arc_m < nearest_m) {
                nearest = cell.echo_motion;
                nearest_m = arc_m;
            }
        }
        return nearest;
    }

    // Returns the mean motion of the tracks that have a motion.
    [[nodiscard]] std::optional<Motion> mean_motion() const {
        Motion sum;
        double count = 0;
        for (const std::size_t i : open_) {
            if (!tracks_[i].motion) continue;
            sum.u_mps += tracks_[i].motion->velocity.u_mps;
            sum.v_mps += tracks_[i].motion->velocity.v_mps;
            ++count;
        }
        if (count == 0) return std::nullopt;
        return Motion{sum.u_mps / count, sum.v_mps / count};
    }

    // Predicts the place of each open track by the motion of the track, else by the motion of the
    // echo near it, else by the mean motion of the other tracks. If none of these is known, the
    // predicted place is the last place, and the search radius grows with fastest_mps, up to
    // farthest_gate_m.
    [[nodiscard]] std::vector<ExpectedCell> expect_cells(const CellScan& scan) const {
        const std::optional<Motion> mean = mean_motion();
        std::vector<ExpectedCell> expected;
        for (const std::size_t i : open_) {
            const CellTrack& track = tracks_[i];
            const CellSighting& last = track.sightings.back();
            const double seconds = seconds_between(last.time, scan.time);
            std::optional<Motion> motion;
            if (track.motion) motion = track.motion->velocity;
            if (!motion) motion = echo_motion_near(scan, last.position);
            if (!motion) motion = mean;
            const double error_mps = motion ? gate_mps : options_.fastest_mps;
            expected.push_back({track.cell, track.spec,
                                moved_place(last.position, motion.value_or(Motion{}), seconds),
                                std::min(gate_m + error_mps * seconds, farthest_gate_m)});
        }
        return expected;
    }

    std::size_t continue_track(std::size_t i, const CellScan& scan, std::size_t j,
                               TrackedCell& cell) {
        CellTrack& track = tracks_[i];
        cell.origin = CellOrigin::continued;
        cell.past = track.sightings;
        see(track, scan, j);
        return i;
    }

    // Begins a track. If the cell is within the moved footprint of a track that continues, it split
    // off from that track and takes over the track's motion.
    std::size_t begin_track(const CellScan& scan, std::size_t j, const CellMatches& matches,
                            TrackedCell& cell) {
        CellTrack track;
        track.id = new_id(scan.time, scan.cells[j].position);
        double greatest = 0;
        for (const CellMatches::Pair& pair : matches.overlaps) {
            CellTrack& parent = tracks_[open_[pair.expected]];
            const double share = pair.overlap.of_found();
            if (pair.found != j || share < least_overlap || share <= greatest ||
                !matches.found_of[pair.expected])
                continue;
            greatest = share;
            cell.origin = CellOrigin::split;
            cell.parents = {parent.id};
            inherit(track, parent.motion);
        }
        if (cell.origin == CellOrigin::split) jumped_.insert(cell.parents.front());
        see(track, scan, j);
        tracks_.push_back(std::move(track));
        return tracks_.size() - 1;
    }

    void see(CellTrack& track, const CellScan& scan, std::size_t j) const {
        const StormCell& cell = scan.cells[j];
        track.sightings.push_back({scan.time, cell.position});
        track.cell = &cell;
        track.spec = &scan.spec;
        if (cell.echo_motion && !track.has_inherited)
            track.prior = TrackMotion{*cell.echo_motion, echo_motion_error_mps};
    }

    // Ends the tracks that were seen in the scan before and are now within the cell of another
    // track.
    void name_merged(const CellMatches& matches, TrackedScan& tracked,
                     const std::vector<std::size_t>& track_of) {
        std::vector<double> greatest(open_.size(), 0.0);
        std::vector<std::size_t> into(open_.size());
        for (const CellMatches::Pair& pair : matches.overlaps) {
            const CellTrack& ended = tracks_[open_[pair.expected]];
            const double share = pair.overlap.of_expected();
            if (matches.found_of[pair.expected] || !matches.expected_of[pair.found] ||
                ended.sightings.back().time != last_time_ || share < least_overlap ||
                share <= greatest[pair.expected])
                continue;
            greatest[pair.expected] = share;
            into[pair.expected] = pair.found;
        }
        for (std::size_t i = 0; i < open_.size(); ++i) {
            if (greatest[i] == 0) continue;
            CellTrack& ended = tracks_[open_[i]];
            TrackedCell& cell = tracked.cells[into[i]];
            cell.origin = CellOrigin::merged;
            cell.parents.push_back(ended.id);
            ended.is_open = false;
            jumped_.insert(tracks_[track_of[into[i]]].id);
        }
    }

    static void inherit(CellTrack& track, const std::optional<TrackMotion>& motion) {
        if (!motion) return;
        track.prior =
            TrackMotion{motion->velocity, std::hypot(motion->error_mps, inherited_error_mps)};
        track.has_inherited = true;
    }

    // Begins a new fitted line when the track has split or merged, because its position jumps. The
    // motion so far becomes the prior.
    static void restart_line(CellTrack& track) {
        inherit(track, track.motion);
        track.fit_from = track.sightings.size() - 1;
    }

    void finish(CellTrack& track, TrackedCell& cell) {
        if (jumped_.erase(track.id) > 0) restart_line(track);
        const std::size_t count = track.sightings.size() - track.fit_from;
        const std::size_t used = std::min(count, options_.most_positions);
        const std::span sightings = std::span(track.sightings).last(used);
        track.motion = motion_of_track(sightings, track.prior, options_.position_error_m);
        cell.id = track.id;
        cell.motion = track.motion;
        if (track.motion)
            cell.forecasts =
                forecast_track(track.sightings.back(), *track.motion, options_.position_error_m);
    }

    // Makes an id from time and place. If the id is taken, adds _2, _3 and so on.
    std::string new_id(UtcTime time, grid::GeoPoint place) {
        const std::string id =
            fmt::format("{}_{:.2f}{}_{:.2f}{}", format_compact(time), std::abs(place.latitude_deg),
                        place.latitude_deg < 0 ? 'S' : 'N', std::abs(place.longitude_deg),
                        place.longitude_deg < 0 ? 'W' : 'E');
        std::string unique = id;
        for (int copy = 2; !ids_.insert(unique).second; ++copy)
            unique = fmt::format("{}_{}", id, copy);
        return unique;
    }

    const TrackOptions& options_;
    std::vector<CellTrack> tracks_;
    std::vector<std::size_t> open_;  // tracks that were open before the scan
    std::set<std::string> ids_;
    std::set<std::string> jumped_;  // tracks that split or merged in this scan
    std::optional<UtcTime> last_time_;
};

Status validate_tracking(std::span<const CellScan> scans, const TrackOptions& options) {
    for (const double number :
         {options.longest_gap_s, options.position_error_m, options.fastest_mps}) {
        if (!(number > 0 && number <= 1e6))
            return fail(ErrorCode::bad_argument, "the options of cell tracks must be above 0");
    }
    if (options.most_positions < 2)
        return fail(ErrorCode::bad_argument, "a motion needs at least two positions");
    for (const CellScan& scan : scans) {
        if (scan.area != scans.front().area)
            return fail(ErrorCode::bad_argument,
                        "cell tracks need scans of one area, not {} and {}", scans.front().area,
                        scan.area);
        if (!scan.cells.empty() && !grid::validate(scan.spec))
            return fail(ErrorCode::bad_argument, "{}: the grid of the cells is not valid",
                        scan.area);
    }
    return {};
}

}  // namespace

Result<std::vector<TrackedScan>> track_cells(std::span<const CellScan> scans,
                                             const TrackOptions& options) {
    if (Status valid = validate_tracking(scans, options); !valid)
        return tl::unexpected(std::move(valid).error());
    std::vector<const CellScan*> in_order;
    for (const CellScan& scan : scans)
        in_order.push_back(&scan);
    std::ranges::stable_sort(in_order, {}, &CellScan::time);
    Tracker tracker(options);
    std::vector<TrackedScan> tracked;
    for (std::size_t i = 0; i < in_order.size(); ++i) {
        const bool is_replaced =
            i + 1 < in_order.size() && in_order[i + 1]->time == in_order[i]->time;
        if (!is_replaced) tracked.push_back(tracker.add(*in_order[i]));
    }
    return tracked;
}

}  // namespace stormcellar::retrieve
