#include "synth/radial_observer.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/degree.h"
#include "grid/beam/detection_limit.h"
#include "synth/counter_random.h"
#include "synth/observe.h"
#include "synth/truth.h"

namespace stormcellar::synth {
namespace {

using level2::Moment;
using level2::SweepMoment;

constexpr std::int32_t first_gate_m = 2125;
constexpr std::int32_t gate_spacing_m = 250;
constexpr int most_gates = 1832;
constexpr int most_doppler_gates = 1192;
constexpr double observed_height_m = 21336;  // 70,000 ft
constexpr float folding_threshold_db = 5;
constexpr std::uint8_t folded_code = 1;

double range_of(std::size_t gate) {
    return first_gate_m + static_cast<double>(gate_spacing_m) * static_cast<double>(gate);
}

// Returns the centers of the gates of one cut, in the plane of their azimuth.
std::vector<grid::EarthPoint> gate_points(const grid::BeamGeometry& beam, const Cut& cut) {
    const double elevation_deg = cut.elevation_deg;
    const std::size_t most = cut.waveform == Waveform::doppler ? most_doppler_gates : most_gates;
    std::vector<grid::EarthPoint> points;
    for (std::size_t gate = 0; gate < most; ++gate) {
        points.push_back(beam.forward({range_of(gate), elevation_deg}));
        // The number of gates is a multiple of four, as in real radars.
        if (points.back().height_m > observed_height_m && points.size() % 4 == 0) break;
    }
    return points;
}

SweepMoment empty_moment(Moment name, float offset, std::size_t radials, std::size_t gates,
                         const Cut& cut) {
    SweepMoment moment;
    moment.moment = name;
    moment.first_gate_m = first_gate_m;
    moment.gate_spacing_m = gate_spacing_m;
    moment.gate_stride = static_cast<std::int32_t>(gates);
    moment.scale = 2;
    moment.offset = offset;
    moment.snr_threshold_db = cut.snr_threshold_db;
    moment.folding_threshold_db = folding_threshold_db;
    moment.gate_counts.assign(radials, static_cast<std::uint16_t>(gates));
    moment.codes8.assign(radials * gates, 0);
    return moment;
}

std::uint8_t code_of(double value, const SweepMoment& moment) {
    const double code = std::round(value * moment.scale + moment.offset);
    return static_cast<std::uint8_t>(std::clamp(code, 2.0, 255.0));
}

// The gates of a ray that may be inside a disc. All gates with echo are among them.
struct GateSpan {
    std::size_t first = 0;
    std::size_t end = 0;
};
using PointIterator = std::vector<grid::EarthPoint>::const_iterator;
GateSpan gates_inside(const Disc& disc, PointIterator begin, PointIterator end, double sine,
                      double cosine) {
    const double along_m = disc.x_m * sine + disc.y_m * cosine;
    const double across_m = disc.x_m * cosine - disc.y_m * sine;
    if (std::abs(across_m) > disc.radius_m) return {};
    const double half_m = std::sqrt(disc.radius_m * disc.radius_m - across_m * across_m);
    const auto before = [](const grid::EarthPoint& point, double arc_m) {
        return point.arc_m < arc_m;
    };
    const auto near = std::lower_bound(begin, end, along_m - half_m, before);
    const auto far = std::lower_bound(near, end, along_m + half_m, before);
    return {static_cast<std::size_t>(near - begin), static_cast<std::size_t>(far - begin)};
}

}  // namespace

RadialObserver::RadialObserver(const Scene& scene, const grid::BeamGeometry& beam, const Cut& cut,
                               const level2::Radial& like, const Place& place)
    : scene_(scene),
      beam_(beam),
      cut_(cut),
      place_(place),
      points_(gate_points(beam, cut)),
      ceiling_m_(echo_ceiling_m(scene.weather)),
      aimed_deg_(cut.elevation_deg),
      echoes_(points_.size()) {
    const std::size_t doppler =
        has_velocity(cut) ? std::min<std::size_t>(points_.size(), most_doppler_gates) : 0;
    ref_ = empty_moment(Moment::ref, 66, place.radials, points_.size(), cut);
    vel_ = empty_moment(Moment::vel, 129, place.radials, doppler, cut);
    sw_ = empty_moment(Moment::sw, 129, place.radials, doppler, cut);
    const auto limit = grid::detection_limit(like, ref_, false);
    for (std::size_t gate = 0; gate < points_.size(); ++gate) {
        limits_dbz_.push_back(limit.at(range_of(gate)));
    }
    if (scene.instrument.has_volume()) make_parts();
}

void RadialObserver::make_parts() {
    sums_.resize(points_.size());
    for (Weather& weather : single_features(scene_.weather)) {
        Part part;
        part.weather = std::move(weather);
        part.ceiling_m = echo_ceiling_m(part.weather);
        part.aimed_deg = std::numeric_limits<double>::quiet_NaN();
        make_bands(part);
        parts_.push_back(std::move(part));
    }
}

// Divides the gates into bands that need the same number of points.
void RadialObserver::make_bands(Part& part) const {
    const Instrument& instrument = scene_.instrument;
    const double width_deg = instrument.beam_width_deg;
    const FinestLengths finest = finest_lengths(part.weather);
    constexpr double of_a_cut_off = 2;
    double across = 0;
    double up = 0;
    for (std::size_t gate = 0; gate < points_.size(); ++gate) {
        const double across_here = points_a_deviation(width_deg, range_of(gate), finest.across_m);
        const double smooth = points_a_deviation(width_deg, range_of(gate), finest.up_m);
        const double up_here = finest.cut_off ? std::max(smooth, of_a_cut_off) : smooth;
        if (across_here == across && up_here == up) {
            ++part.bands.back().end;
            continue;
        }
        across = across_here;
        up = up_here;
        Band band;
        band.first = gate;
        band.end = gate + 1;
        band.azimuths = azimuth_nodes(width_deg, static_cast<double>(cut_.elevation_deg),
                                      static_cast<double>(cut_.azimuth_spacing_deg), across);
        for (const BeamNode& elevation : elevation_nodes(width_deg, up)) {
            for (const BeamNode& range : range_nodes(instrument.pulse_length_m)) {
                band.rows.push_back(
                    {elevation.offset, range.offset, elevation.weight * range.weight, {}});
            }
        }
        part.bands.push_back(std::move(band));
    }
}

// Computes the places of the gates on a ray that has the elevation of the radial.
void RadialObserver::aim(const level2::Radial& radial) {
    const double elevation_deg = radial.elevation_deg;
    if (elevation_deg == aimed_deg_) return;
    aimed_deg_ = elevation_deg;
    for (std::size_t gate = 0; gate < points_.size(); ++gate) {
        points_[gate] = beam_.forward({range_of(gate), elevation_deg});
    }
}

// Computes the points of a part. The first call does so for all gates. The antenna jitters, so
// later calls do so again, but only for the gates that may be over the disc.
void RadialObserver::aim(Part& part, double elevation_deg, const Disc& disc) const {
    if (elevation_deg == part.aimed_deg) return;
    const bool first_time = std::isnan(part.aimed_deg);
    part.aimed_deg = elevation_deg;
    // larger than the range by which the edges of a beam are offset
    constexpr double slack_m = 3000;
    const double distance_m = std::hypot(disc.x_m, disc.y_m);
    for (Band& band : part.bands) {
        for (Row& row : band.rows) {
            row.points.resize(band.end - band.first);
            for (std::size_t gate = band.first; gate < band.end; ++gate) {
                const double off_m = std::abs(points_[gate].arc_m - distance_m);
                if (!first_time && off_m > disc.radius_m + slack_m) continue;
                row.points[gate - band.first] =
                    beam_.forward({range_of(gate) + row.range_offset_m,
                                   elevation_deg + row.elevation_offset_deg});
            }
        }
    }
}

// Returns true if any ray of the beam may pass over a disc.
bool RadialObserver::may_meet(const Disc& disc, const level2::Radial& radial) const {
    const double distance_m = std::hypot(disc.x_m, disc.y_m);
    if (distance_m <= disc.radius_m) return true;
    const double off_deg =
        std::remainder(std::atan2(disc.x_m, disc.y_m) / degree - radial.azimuth_deg, 360);
    const double half_deg = std::asin(disc.radius_m / distance_m) / degree;
    const double deviation_deg = pattern_deviation_deg(scene_.instrument.beam_width_deg);
    const double beam_deg = 4 * deviation_deg / std::cos(radial.elevation_deg * degree) +
                            static_cast<double>(cut_.azimuth_spacing_deg);
    return std::abs(off_deg) <= half_deg + beam_deg;
}

// Calls use(gate, point, sine, cosine) once for each gate of a ray that may hold echo.
template <typename Use>
void RadialObserver::walk(const Ray& ray, const std::vector<Disc>& discs, double ceiling_m,
                          Use use) {
    const double sine = std::sin(ray.azimuth_deg * degree);
    const double cosine = std::cos(ray.azimuth_deg * degree);
    std::vector<GateSpan> spans;
    for (const Disc& disc : discs) {
        const GateSpan span =
            gates_inside(disc, ray.points->begin(), ray.points->end(), sine, cosine);
        if (span.first < span.end) spans.push_back(span);
    }
    std::sort(spans.begin(), spans.end(),
              [](const GateSpan& a, const GateSpan& b) { return a.first < b.first; });
    std::size_t done = 0;  // gates before this one are observed
    for (const GateSpan& span : spans) {
        for (std::size_t i = std::max(done, span.first); i < span.end; ++i) {
            const grid::EarthPoint& earth = (*ray.points)[i];
            if (earth.height_m > ceiling_m) continue;
            use(ray.first + i, Point{earth.arc_m * sine, earth.arc_m * cosine, earth.height_m},
                sine, cosine);
        }
        done = std::max(done, span.end);
    }
}

void RadialObserver::observe(std::size_t row, std::size_t number, const level2::Radial& radial,
                             double t_s) {
    aim(radial);
    if (!scene_.instrument.changes_gates()) return observe_points(row, radial, t_s);
    sample(radial, t_s);
    folded_ = find_folded();
    write_echoes(row, number);
}

void RadialObserver::sample(const level2::Radial& radial, double t_s) {
    const Instrument& instrument = scene_.instrument;
    aim(radial);
    std::fill(echoes_.begin(), echoes_.end(), GateEcho{no_echo_dbz, 0, 0});
    if (instrument.has_volume()) {
        sample_beam(radial, t_s);
    } else {
        sample_points(radial, t_s);
    }
    if (instrument.clutter) add_clutter(radial);
}

void RadialObserver::write_gate(std::size_t row, std::size_t gate, const GateEcho& echo) {
    const auto at = [row, gate](const SweepMoment& moment) {
        return row * static_cast<std::size_t>(moment.gate_stride) + gate;
    };
    ref_.codes8[at(ref_)] = code_of(echo.dbz, ref_);
    if (gate >= doppler_gates()) return;
    const bool folded = !folded_.empty() && folded_[gate];
    vel_.codes8[at(vel_)] = folded ? folded_code : code_of(echo.away_mps, vel_);
    sw_.codes8[at(sw_)] = folded ? folded_code : code_of(echo.width_mps, sw_);
}

// Observes one radial if no effect of the instrument changes gates.
void RadialObserver::observe_points(std::size_t row, const level2::Radial& radial, double t_s) {
    const Ray axis{radial.azimuth_deg, radial.elevation_deg, 1, 0, points_.size(), &points_};
    const double elevation_cosine = std::cos(radial.elevation_deg * degree);
    walk(axis, echo_discs(scene_.weather, t_s), ceiling_m_,
         [&](std::size_t gate, const Point& point, double sine, double cosine) {
             const Echo echo = truth(scene_.weather, point, t_s);
             if (!(echo.dbz >= limits_dbz_[gate])) return;
             const double away_mps =
                 (echo.motion.east_mps * sine + echo.motion.north_mps * cosine) * elevation_cosine;
             write_gate(row, gate, {echo.dbz, away_mps, spectrum_width_mps});
         });
}

void RadialObserver::sample_points(const level2::Radial& radial, double t_s) {
    const Ray axis{radial.azimuth_deg, radial.elevation_deg, 1, 0, points_.size(), &points_};
    const double elevation_cosine = std::cos(radial.elevation_deg * degree);
    walk(axis, echo_discs(scene_.weather, t_s), ceiling_m_,
         [&](std::size_t gate, const Point& point, double sine, double cosine) {
             const Echo echo = truth(scene_.weather, point, t_s);
             const double away_mps =
                 (echo.motion.east_mps * sine + echo.motion.north_mps * cosine) * elevation_cosine;
             echoes_[gate] = {echo.dbz, away_mps, spectrum_width_mps};
         });
}

// Adds up the echo of every ray of the beam with its weight, and takes the mean of each gate.
void RadialObserver::sample_beam(const level2::Radial& radial, double t_s) {
    std::fill(sums_.begin(), sums_.end(), BeamSum{});
    for (Part& part : parts_) {
        const auto discs = echo_discs(part.weather, t_s);
        if (!may_meet(discs.front(), radial)) continue;
        aim(part, radial.elevation_deg, discs.front());
        for (const Band& band : part.bands) {
            for (const Row& row : band.rows) {
                for (const BeamNode& azimuth : band.azimuths) {
                    sum_ray({radial.azimuth_deg + azimuth.offset,
                             radial.elevation_deg + row.elevation_offset_deg,
                             row.weight * azimuth.weight, band.first, band.end, &row.points},
                            part, discs, t_s);
                }
            }
        }
    }
    for (std::size_t gate = 0; gate < sums_.size(); ++gate) {
        const BeamSum& sum = sums_[gate];
        if (sum.z <= 0) continue;
        const double away_mps = sum.moment_1 / sum.z;
        const double spread = std::max(0.0, sum.moment_2 / sum.z - away_mps * away_mps);
        constexpr double own_mps = spectrum_width_mps;
        echoes_[gate] = {10 * std::log10(sum.z), away_mps, std::sqrt(own_mps * own_mps + spread)};
    }
}

void RadialObserver::sum_ray(const Ray& ray, const Part& part, const std::vector<Disc>& discs,
                             double t_s) {
    const double elevation_cosine = std::cos(ray.elevation_deg * degree);
    walk(ray, discs, part.ceiling_m,
         [&](std::size_t gate, const Point& point, double sine, double cosine) {
             const LinearEcho echo = linear_truth(part.weather, point, t_s);
             const double z = ray.weight * echo.z_mm6_m3;
             const double away_mps =
                 (echo.motion.east_mps * sine + echo.motion.north_mps * cosine) * elevation_cosine;
             BeamSum& sum = sums_[gate];
             sum.z += z;
             sum.moment_1 += z * away_mps;
             sum.moment_2 += z * away_mps * away_mps;
         });
}

void RadialObserver::add_clutter(const level2::Radial& radial) {
    constexpr double usual_width_deg = 0.95;
    const Instrument& instrument = scene_.instrument;
    const double width_deg =
        instrument.beam_width_deg > 0 ? instrument.beam_width_deg : usual_width_deg;
    const ClutterBeam beam{radial.azimuth_deg, radial.elevation_deg, width_deg};
    const double reach_m = clutter_reach_m(*instrument.clutter);
    for (std::size_t gate = 0; gate < echoes_.size() && range_of(gate) < reach_m; ++gate) {
        const double dbz = clutter_dbz(*instrument.clutter, instrument.seed, beam, range_of(gate));
        echoes_[gate] = sum_of(echoes_[gate], {dbz, 0, clutter_width_mps});
    }
}

// Returns the gates whose velocities are folded. Only Doppler and batch cuts have any. Reflectivity
// is never folded, because it is computed as in a surveillance cut.
std::vector<bool> RadialObserver::find_folded() const {
    const bool ambiguous = cut_.waveform == Waveform::doppler || cut_.waveform == Waveform::batch;
    if (!scene_.instrument.range_folding || !ambiguous) return {};
    std::vector<double> power;
    for (std::size_t gate = 0; gate < echoes_.size(); ++gate) {
        power.push_back(std::pow(10, echoes_[gate].dbz / 10) / (range_of(gate) * range_of(gate)));
    }
    const double trip_gates =
        static_cast<double>(unambiguous_range_m(cut_)) / static_cast<double>(gate_spacing_m);
    return overlaid_gates(power, trip_gates, static_cast<double>(folding_threshold_db));
}

// Returns the radar's estimate for a gate, with or without echo.
GateEcho RadialObserver::estimate(const DrawPlace& place, std::size_t gate) const {
    const Instrument& instrument = scene_.instrument;
    GateEcho echo = echoes_[gate];
    const auto nyquist = static_cast<double>(nyquist_mps(cut_));
    const double of_noise_mps = noise_width_mps(nyquist);
    if (instrument.noise_db > 0 || instrument.velocity_noise_mps > 0) {
        const RandomWords words = draw(instrument.seed, Draw::gate, place);
        const NormalPair normals = normals_of(words[0], words[1]);
        const double noise_dbz = limits_dbz_[gate] - static_cast<double>(cut_.snr_threshold_db);
        if (echo.dbz > no_echo_dbz) {
            const double deviation_mps =
                velocity_deviation_mps(echo.dbz, noise_dbz, instrument.velocity_noise_mps);
            echo.away_mps += normals.second * std::min(deviation_mps, of_noise_mps);
        } else {
            echo.away_mps = nyquist * (2 * uniform_of(words[2]) - 1);
            echo.width_mps = of_noise_mps;
        }
        if (instrument.noise_db > 0) {
            echo.dbz = noisy_dbz(echo.dbz, noise_dbz, instrument.noise_db, normals.first);
        }
    }
    if (instrument.velocity_folding && has_velocity(cut_)) {
        echo.away_mps = wrapped_mps(echo.away_mps, nyquist);
    }
    return echo;
}

void RadialObserver::write_echoes(std::size_t row, std::size_t number) {
    const Instrument& instrument = scene_.instrument;
    const bool noisy = instrument.noise_db > 0;
    const auto nyquist = static_cast<double>(nyquist_mps(cut_));
    for (std::size_t gate = 0; gate < echoes_.size(); ++gate) {
        const DrawPlace place{static_cast<std::uint32_t>(place_.volume),
                              static_cast<std::uint32_t>(place_.cut),
                              static_cast<std::uint32_t>(number), static_cast<std::uint32_t>(gate)};
        if (is_missing_gate(instrument, place)) continue;
        if (echoes_[gate].dbz == no_echo_dbz) {
            const auto speckle = speckle_at(instrument, place, limits_dbz_[gate], nyquist);
            if (speckle) write_gate(row, gate, *speckle);
            if (speckle) continue;
        }
        if (!noisy && !(echoes_[gate].dbz >= limits_dbz_[gate])) continue;
        const GateEcho echo = estimate(place, gate);
        if (echo.dbz >= limits_dbz_[gate]) write_gate(row, gate, echo);
    }
}

std::vector<SweepMoment> RadialObserver::take() {
    std::vector<SweepMoment> moments;
    moments.push_back(std::move(ref_));
    if (has_velocity(cut_)) {
        moments.push_back(std::move(vel_));
        moments.push_back(std::move(sw_));
    }
    return moments;
}

}  // namespace stormcellar::synth
