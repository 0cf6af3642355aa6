// synth/radial_observer.h -- observes the gates of one sweep, radial by radial.
//
// It takes samples of the truth, applies the effects of the instrument, and makes codes.
//
// Units     Meters, degrees, seconds since the start of the scene.
// Threads   One thread at a time. The scene and the beam must outlive it.
#pragma once

#include <optional>
#include <vector>

#include "stormcellar/grid/beam_geometry.h"
#include "stormcellar/level2/volume.h"
#include "synth/beam_quadrature.h"
#include "synth/synth_effects.h"
#include "synth/synth_scene.h"

namespace stormcellar::synth {

class RadialObserver {
  public:
    struct Place {
        int volume = 0;           // from 0
        int cut = 1;              // from 1
        std::size_t radials = 0;  // rows of the sweep
    };
    // `like` is any radial of the sweep. Its calibration sets the detection limits.
    RadialObserver(const Scene& scene, const grid::BeamGeometry& beam, const Cut& cut,
                   const level2::Radial& like, const Place& place);

    // Fills a row. `number` is the radial's number in the full turn, in which lost radials count.
    void observe(std::size_t row, std::size_t number, const level2::Radial& radial, double t_s);

    // Computes the echo of each gate along a radial, before noise, folding, loss and speckle. The
    // echo is the mean over the beam and the pulse if the instrument has a volume, else the sample
    // at the gate's center. Clutter is added if the instrument has it.
    void sample(const level2::Radial& radial, double t_s);
    [[nodiscard]] const std::vector<GateEcho>& echoes() const { return echoes_; }

    // Returns the observed moments. Do not call observe() after take().
    [[nodiscard]] std::vector<level2::SweepMoment> take();

  private:
    // The gates [first, end) of one straight ray inside the beam.
    struct Ray {
        double azimuth_deg = 0;
        double elevation_deg = 0;
        double weight = 1;
        std::size_t first = 0;
        std::size_t end = 0;
        const std::vector<grid::EarthPoint>* points = nullptr;
    };
    // Rays with the same elevation and the same offset in range.
    struct Row {
        double elevation_offset_deg = 0;
        double range_offset_m = 0;
        double weight = 1;
        std::vector<grid::EarthPoint> points;
    };
    // A range of gates that the same rays sample.
    struct Band {
        std::size_t first = 0;
        std::size_t end = 0;
        std::vector<BeamNode> azimuths;
        std::vector<Row> rows;
    };
    // A feature of the weather, and how it is sampled.
    struct Part {
        Weather weather;
        double ceiling_m = 0;
        double aimed_deg = 0;  // elevation of the computed points; NaN: not computed
        std::vector<Band> bands;
    };
    // Sums over the beam, in mm^6/m^3.
    struct BeamSum {
        double z = 0;
        double moment_1 = 0;  // z v
        double moment_2 = 0;  // z v^2
    };

    void make_parts();
    void make_bands(Part& part) const;
    [[nodiscard]] bool may_meet(const Disc& disc, const level2::Radial& radial) const;
    void aim(const level2::Radial& radial);
    void aim(Part& part, double elevation_deg, const Disc& disc) const;
    template <typename Use>
    static void walk(const Ray& ray, const std::vector<Disc>& discs, double ceiling_m, Use use);
    void observe_points(std::size_t row, const level2::Radial& radial, double t_s);
    void sample_points(const level2::Radial& radial, double t_s);
    void sample_beam(const level2::Radial& radial, double t_s);
    void sum_ray(const Ray& ray, const Part& part, const std::vector<Disc>& discs, double t_s);
    void add_clutter(const level2::Radial& radial);
    [[nodiscard]] std::vector<bool> find_folded() const;
    void write_echoes(std::size_t row, std::size_t number);
    void write_gate(std::size_t row, std::size_t gate, const GateEcho& echo);
    [[nodiscard]] GateEcho estimate(const DrawPlace& place, std::size_t gate) const;
    [[nodiscard]] std::size_t doppler_gates() const {
        return static_cast<std::size_t>(vel_.gate_stride);
    }

    const Scene& scene_;
    const grid::BeamGeometry& beam_;
    Cut cut_;
    Place place_;
    std::vector<grid::EarthPoint> points_;  // of the gates, on the axis of the beam
    std::vector<double> limits_dbz_;        // weakest reflectivity that is shown, by gate
    double ceiling_m_ = 0;                  // no echo is higher
    double aimed_deg_ = 0;                  // elevation of the computed points
    std::vector<Part> parts_;               // for a beam with a width
    std::vector<BeamSum> sums_;
    std::vector<GateEcho> echoes_;
    std::vector<bool> folded_;
    level2::SweepMoment ref_;
    level2::SweepMoment vel_;
    level2::SweepMoment sw_;
};

}  // namespace stormcellar::synth
