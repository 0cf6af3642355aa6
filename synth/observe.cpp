#include "synth/observe.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "grid/beam_geometry.h"
#include "grid/detection_limit.h"

namespace stormcellar::synth {
namespace {

using level2::Moment;
using level2::SweepMoment;

constexpr double degree = std::numbers::pi / 180;
constexpr std::int32_t first_gate_m = 2125;
constexpr std::int32_t gate_spacing_m = 250;
constexpr int most_gates = 1832;
constexpr int most_doppler_gates = 1192;
constexpr double observed_height_m = 21336;  // 70,000 ft

// A real radar's, 2022.
constexpr float calibration_dbz = -42.875F;
constexpr float vertical_calibration_dbz = -42.5F;
constexpr float horizontal_noise_dbm = -81.5F;
constexpr float vertical_noise_dbm = -81.25F;
constexpr std::int16_t attenuation_thousandths = -12;

// Gate centres of one cut: where each lies in the plane of its azimuth.
std::vector<grid::EarthPoint> gate_points(const grid::BeamGeometry& beam, const Cut& cut) {
    const double elevation_deg = cut.elevation_deg;
    const int most = cut.waveform == Waveform::doppler ? most_doppler_gates : most_gates;
    std::vector<grid::EarthPoint> points;
    for (int gate = 0; gate < most; ++gate) {
        const double range_m = first_gate_m + static_cast<double>(gate_spacing_m) * gate;
        points.push_back(beam.forward({range_m, elevation_deg}));
        // Gate counts are multiples of four, as the RDA's are.
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
    moment.folding_threshold_db = 5;
    moment.gate_counts.assign(radials, static_cast<std::uint16_t>(gates));
    moment.codes8.assign(radials * gates, 0);
    return moment;
}

std::uint8_t code_of(double value, const SweepMoment& moment) {
    const double code = std::round(value * moment.scale + moment.offset);
    return static_cast<std::uint8_t>(std::clamp(code, 2.0, 255.0));
}

// One sweep as it is filled.
struct SweepWork {
    const Weather& weather;
    const std::vector<grid::EarthPoint>& points;
    std::vector<double> limits_dbz;  // weakest reflectivity shown, by gate
    double ceiling_m = 0;            // no echo is higher
    SweepMoment ref;
    SweepMoment vel;
    SweepMoment sw;
};

// Which gates of a radial lie inside some disc: a superset of those with echo.
struct GateSpan {
    std::size_t first = 0;
    std::size_t end = 0;
};
GateSpan gates_inside(const Disc& disc, const std::vector<grid::EarthPoint>& points, double sine,
                      double cosine) {
    const double along_m = disc.x_m * sine + disc.y_m * cosine;
    const double across_m = disc.x_m * cosine - disc.y_m * sine;
    if (std::abs(across_m) > disc.radius_m) return {};
    const double half_m = std::sqrt(disc.radius_m * disc.radius_m - across_m * across_m);
    const auto before = [](const grid::EarthPoint& point, double arc_m) {
        return point.arc_m < arc_m;
    };
    const auto first = std::lower_bound(points.begin(), points.end(), along_m - half_m, before);
    const auto end = std::lower_bound(first, points.end(), along_m + half_m, before);
    return {static_cast<std::size_t>(first - points.begin()),
            static_cast<std::size_t>(end - points.begin())};
}

void observe_gate(SweepWork& work, std::size_t row, std::size_t gate, const Point& point,
                  double t_s, double sine, double cosine, double elevation_cosine) {
    const Echo echo = truth(work.weather, point, t_s);
    if (!(echo.dbz >= work.limits_dbz[gate])) return;
    const auto at = [row, gate](const SweepMoment& moment) {
        return row * static_cast<std::size_t>(moment.gate_stride) + gate;
    };
    work.ref.codes8[at(work.ref)] = code_of(echo.dbz, work.ref);
    if (gate < static_cast<std::size_t>(work.vel.gate_stride)) {
        const double away_mps =
            (echo.motion.east_mps * sine + echo.motion.north_mps * cosine) * elevation_cosine;
        work.vel.codes8[at(work.vel)] = code_of(away_mps, work.vel);
        work.sw.codes8[at(work.sw)] = code_of(spectrum_width_mps, work.sw);
    }
}

void observe_radial(SweepWork& work, std::size_t row, const level2::Radial& radial, double t_s) {
    const double sine = std::sin(radial.azimuth_deg * degree);
    const double cosine = std::cos(radial.azimuth_deg * degree);
    const double elevation_cosine = std::cos(radial.elevation_deg * degree);
    std::vector<GateSpan> spans;
    for (const Disc& disc : echo_discs(work.weather, t_s)) {
        const GateSpan span = gates_inside(disc, work.points, sine, cosine);
        if (span.first < span.end) spans.push_back(span);
    }
    std::sort(spans.begin(), spans.end(),
              [](const GateSpan& a, const GateSpan& b) { return a.first < b.first; });
    std::size_t done = 0;  // gates before this one are observed
    for (const GateSpan& span : spans) {
        for (std::size_t gate = std::max(done, span.first); gate < span.end; ++gate) {
            const grid::EarthPoint& earth = work.points[gate];
            if (earth.height_m > work.ceiling_m) continue;
            const Point point{earth.arc_m * sine, earth.arc_m * cosine, earth.height_m};
            observe_gate(work, row, gate, point, t_s, sine, cosine, elevation_cosine);
        }
        done = std::max(done, span.end);
    }
}

level2::Radial radial_of(const Cut& cut, std::size_t index, std::size_t count, double azimuth_deg,
                         UtcTime time) {
    level2::Radial radial;
    radial.time = time;
    radial.azimuth_deg = static_cast<float>(azimuth_deg);
    radial.elevation_deg = cut.elevation_deg;
    radial.nyquist_mps = nyquist_mps(cut);
    radial.unambiguous_range_m = unambiguous_range_m(cut);
    radial.calibration_dbz = calibration_dbz;
    radial.vertical_calibration_dbz = vertical_calibration_dbz;
    radial.horizontal_noise_dbm = horizontal_noise_dbm;
    radial.vertical_noise_dbm = vertical_noise_dbm;
    radial.attenuation_db_per_km_thousandths = attenuation_thousandths;
    radial.elevation_calibration_db = calibration_dbz;
    radial.azimuth_number = static_cast<std::uint16_t>(index + 1);
    radial.status = index + 1 == count ? 2 : 1;
    radial.cut_sector = 1;
    radial.azimuth_indexing = cut.azimuth_spacing_deg < 1 ? 25 : 50;  // hundredths of a degree
    return radial;
}

// Runs through the cuts of one volume as the antenna does.
class Antenna {
  public:
    Antenna(const Scene& scene, int number)
        : scene_(scene),
          start_(scene.schedule.start_of(number)),
          scene_s_(std::chrono::duration<double>(start_ - scene.schedule.start).count()),
          beam_(scene.site.latitude_deg, scene.site.antenna_altitude_m) {}

    level2::Sweep run(const Cut& cut, int elevation_number) {
        const double spacing_deg = cut.azimuth_spacing_deg;
        const auto count = static_cast<std::size_t>(std::lround(360 / spacing_deg));
        const auto points = gate_points(beam_, cut);
        SweepWork work = begin(cut, points, count);

        level2::Sweep sweep;
        sweep.elevation_number = elevation_number;
        sweep.azimuth_spacing_deg = cut.azimuth_spacing_deg;
        sweep.vcp_elevation_deg = cut.elevation_deg;
        // Radials are centred on odd multiples of half their spacing.
        const double first = std::ceil(azimuth_deg_ / spacing_deg);
        for (std::size_t i = 0; i < count; ++i) {
            const double steps = first + static_cast<double>(i) + 0.5;
            const double azimuth_deg = std::fmod(steps * spacing_deg, 360);
            const double since_start_s =
                elapsed_s_ + static_cast<double>(i) * spacing_deg / cut.azimuth_rate_deg_s;
            const auto ms = std::chrono::milliseconds(std::llround(since_start_s * 1000));
            sweep.radials.push_back(radial_of(cut, i, count, azimuth_deg, start_ + ms));
            // The radial's own time, to the millisecond, is the one that its data are true for.
            const double t_s = scene_s_ + std::chrono::duration<double>(ms).count();
            observe_radial(work, i, sweep.radials.back(), t_s);
        }
        elapsed_s_ += duration_s(cut);
        azimuth_deg_ = std::fmod(azimuth_deg_ + cut.azimuth_rate_deg_s * move_s, 360);
        sweep.moments.push_back(std::move(work.ref));
        if (has_velocity(cut)) {
            sweep.moments.push_back(std::move(work.vel));
            sweep.moments.push_back(std::move(work.sw));
        }
        return sweep;
    }

  private:
    [[nodiscard]] SweepWork begin(const Cut& cut, const std::vector<grid::EarthPoint>& points,
                                  std::size_t radials) const {
        const std::size_t doppler_gates =
            has_velocity(cut) ? std::min<std::size_t>(points.size(), most_doppler_gates) : 0;
        SweepWork work{scene_.weather,
                       points,
                       {},
                       echo_ceiling_m(scene_.weather),
                       empty_moment(Moment::ref, 66, radials, points.size(), cut),
                       empty_moment(Moment::vel, 129, radials, doppler_gates, cut),
                       empty_moment(Moment::sw, 129, radials, doppler_gates, cut)};
        const level2::Radial radial = radial_of(cut, 0, 1, 0, start_);
        const auto limit = grid::detection_limit(radial, work.ref, false);
        for (std::size_t gate = 0; gate < points.size(); ++gate) {
            work.limits_dbz.push_back(limit.at(work.ref.range_m(static_cast<std::int32_t>(gate))));
        }
        return work;
    }

    const Scene& scene_;
    UtcTime start_;
    double scene_s_;  // from the scene's start to the volume's
    grid::BeamGeometry beam_;
    double elapsed_s_ = 0;
    double azimuth_deg_ = 0;
};

level2::VolumeBlock block_of(const Scene& scene) {
    constexpr int usual_tower_m = 20;
    const int altitude_m = scene.site.antenna_altitude_m;
    // A tower as high as its site would read as a TDWR's way of writing.
    const int tower_m = altitude_m == 2 * usual_tower_m ? usual_tower_m - 1 : usual_tower_m;
    level2::VolumeBlock block;
    block.version_major = 2;
    block.latitude_deg = static_cast<float>(scene.site.latitude_deg);
    block.longitude_deg = static_cast<float>(scene.site.longitude_deg);
    block.site_height_m = static_cast<std::int16_t>(altitude_m - tower_m);
    block.tower_height_m = static_cast<std::uint16_t>(tower_m);
    block.calibration_db = calibration_dbz;
    block.vcp = static_cast<std::uint16_t>(scene.schedule.pattern.number);
    return block;
}

}  // namespace

level2::Volume observe(const Scene& scene, int number) {
    level2::Volume volume;
    const NexradTime start = nexrad_from_time(scene.schedule.start_of(number));
    const std::string name = fmt::format("AR2V0006.{:03}", (number + 1) % 1000);
    volume.header = level2::VolumeHeader{name, start.day, start.milliseconds, scene.site.station};
    volume.station = scene.site.station;
    volume.block = block_of(scene);
    volume.vcp_message = to_message(scene.schedule.pattern);
    volume.vcp = scene.schedule.pattern.number;
    volume.vcp_source = level2::VcpSource::message_5;
    Antenna antenna(scene, number);
    int elevation_number = 0;
    for (const Cut& cut : scene.schedule.pattern.cuts) {
        volume.sweeps.push_back(antenna.run(cut, ++elevation_number));
        volume.sweeps.back().radials.front().status = 0;
    }
    volume.sweeps.front().radials.front().status = 3;
    volume.sweeps.back().radials.back().status = 4;
    return volume;
}

std::string volume_file_name(const Scene& scene, int number) {
    return fmt::format("{}{}_V06", scene.site.station,
                       format_compact(scene.schedule.start_of(number)));
}

}  // namespace stormcellar::synth
