#include "synth/observe.h"

#include <cmath>

#include "stormcellar/grid/beam_geometry.h"
#include "synth/radial_observer.h"
#include "synth/synth_effects.h"

namespace stormcellar::synth {
namespace {

// as in a real radar, 2022
constexpr float calibration_dbz = -42.875F;
constexpr float vertical_calibration_dbz = -42.5F;
constexpr float horizontal_noise_dbm = -81.5F;
constexpr float vertical_noise_dbm = -81.25F;
constexpr std::int16_t attenuation_thousandths = -12;

// A radial's place in the turn of its cut, and the direction in which the antenna points.
struct Pointing {
    std::size_t number = 0;  // from 0, lost radials included
    double azimuth_deg = 0;  // [0, 360)
    double elevation_deg = 0;
    std::chrono::milliseconds since_start{0};  // since the start of the volume
};

level2::Radial radial_of(const Cut& cut, const Pointing& pointing, UtcTime volume_start) {
    level2::Radial radial;
    radial.time = volume_start + pointing.since_start;
    radial.azimuth_deg = static_cast<float>(pointing.azimuth_deg);
    radial.elevation_deg = static_cast<float>(pointing.elevation_deg);
    radial.nyquist_mps = nyquist_mps(cut);
    radial.unambiguous_range_m = unambiguous_range_m(cut);
    radial.calibration_dbz = calibration_dbz;
    radial.vertical_calibration_dbz = vertical_calibration_dbz;
    radial.horizontal_noise_dbm = horizontal_noise_dbm;
    radial.vertical_noise_dbm = vertical_noise_dbm;
    radial.attenuation_db_per_km_thousandths = attenuation_thousandths;
    radial.elevation_calibration_db = calibration_dbz;
    radial.azimuth_number = static_cast<std::uint16_t>(pointing.number + 1);
    radial.cut_sector = 1;
    radial.azimuth_indexing = cut.azimuth_spacing_deg < 1 ? 25 : 50;  // in hundredths of a degree
    return radial;
}

// Goes through the cuts of one volume as the antenna does.
class Antenna {
  public:
    Antenna(const Scene& scene, int number)
        : scene_(scene),
          number_(number),
          start_(scene.schedule.start_of(number)),
          scene_s_(std::chrono::duration<double>(start_ - scene.schedule.start).count()),
          beam_(scene.site.latitude_deg, scene.site.antenna_altitude_m) {}

    // Returns a sweep. The sweep has no radials if all radials are lost.
    level2::Sweep run(const Cut& cut, int elevation_number) {
        const std::vector<Pointing> pointings = turn(cut, elevation_number);
        level2::Sweep sweep;
        sweep.elevation_number = elevation_number;
        sweep.azimuth_spacing_deg = cut.azimuth_spacing_deg;
        sweep.vcp_elevation_deg = cut.elevation_deg;
        if (pointings.empty()) return sweep;
        for (const Pointing& pointing : pointings) {
            sweep.radials.push_back(radial_of(cut, pointing, start_));
        }
        RadialObserver observer(scene_, beam_, cut, sweep.radials.front(),
                                {number_, elevation_number, pointings.size()});
        for (std::size_t row = 0; row < pointings.size(); ++row) {
            // Observe the weather at the time that the radial states, in whole milliseconds.
            const double t_s =
                scene_s_ + std::chrono::duration<double>(pointings[row].since_start).count();
            observer.observe(row, pointings[row].number, sweep.radials[row], t_s);
        }
        sweep.moments = observer.take();
        return sweep;
    }

  private:
    // Makes one turn of the antenna, leaves out the lost radials, and moves to the next cut.
    std::vector<Pointing> turn(const Cut& cut, int elevation_number) {
        const Instrument& instrument = scene_.instrument;
        const double spacing_deg = cut.azimuth_spacing_deg;
        const auto count = static_cast<std::size_t>(std::lround(360 / spacing_deg));
        // The centers of radials are at odd multiples of half their spacing.
        const double first = std::ceil(azimuth_deg_ / spacing_deg);
        std::vector<Pointing> pointings;
        for (std::size_t i = 0; i < count; ++i) {
            const double in_cut_s = static_cast<double>(i) * spacing_deg / cut.azimuth_rate_deg_s;
            const double steps = first + static_cast<double>(i) + 0.5;
            Pointing pointing;
            pointing.number = i;
            pointing.azimuth_deg = std::fmod(steps * spacing_deg, 360);
            pointing.elevation_deg = static_cast<double>(cut.elevation_deg);
            pointing.since_start =
                std::chrono::milliseconds(std::llround((elapsed_s_ + in_cut_s) * 1000));
            const RadialPlace place{number_, elevation_number, static_cast<int>(i),
                                    pointing.azimuth_deg};
            if (is_missing(instrument, place)) continue;
            jitter(pointing, elevation_number, in_cut_s);
            pointings.push_back(pointing);
        }
        elapsed_s_ += duration_s(cut);
        azimuth_deg_ = std::fmod(azimuth_deg_ + cut.azimuth_rate_deg_s * move_s, 360);
        return pointings;
    }

    void jitter(Pointing& pointing, int elevation_number, double in_cut_s) const {
        const Instrument& instrument = scene_.instrument;
        if (instrument.azimuth_jitter_deg <= 0 && instrument.elevation_jitter_deg <= 0) return;
        const Jitter off = jitter_at(instrument.seed, number_, elevation_number, in_cut_s);
        pointing.elevation_deg += instrument.elevation_jitter_deg * off.elevation;
        const double azimuth_deg =
            pointing.azimuth_deg + instrument.azimuth_jitter_deg * off.azimuth;
        const double turned_deg = std::fmod(azimuth_deg + 360, 360);
        // Otherwise the largest float below 360 would become 360.
        pointing.azimuth_deg = static_cast<float>(turned_deg) < 360.0F ? turned_deg : 0;
    }

    const Scene& scene_;
    int number_;
    UtcTime start_;
    double scene_s_;  // from the start of the scene to the start of the volume
    grid::BeamGeometry beam_;
    double elapsed_s_ = 0;
    double azimuth_deg_ = 0;
};

level2::VolumeBlock block_of(const Scene& scene) {
    constexpr int usual_tower_m = 20;
    const int altitude_m = scene.site.antenna_altitude_m;
    // If tower and ground had the same height, readers would take the radar for a TDWR.
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
        level2::Sweep sweep = antenna.run(cut, ++elevation_number);
        if (sweep.radials.empty()) continue;
        sweep.radials.back().status = 2;
        sweep.radials.front().status = 0;
        volume.sweeps.push_back(std::move(sweep));
    }
    if (volume.sweeps.empty()) return volume;
    volume.sweeps.front().radials.front().status = 3;
    volume.sweeps.back().radials.back().status = 4;
    return volume;
}

std::string volume_file_name(const Scene& scene, int number) {
    return fmt::format("{}{}_V06", scene.site.station,
                       format_compact(scene.schedule.start_of(number)));
}

}  // namespace stormcellar::synth
