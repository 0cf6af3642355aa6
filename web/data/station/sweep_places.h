// web/data/station/sweep_places.h -- the places of the sweeps of one scan pattern.
//
// The volumes of a pattern differ: AVSET drops high sweeps, SAILS and MRLE repeat low ones. So a
// place is a kind of sweep and how often this kind came before in the volume. A repeated sweep has
// its own place wherever the radar inserts it, and a volume without it has nothing there. Places
// are numbered in the order in which they are learned. learn() never changes the number of a place,
// and only adds moments and gates to it. Python's open_archive() has the same places if it learns
// the same volumes (python/stormcellar/archives.py).
//
// Units     Meters, degrees.
// Threads   Plain data: many threads may read it while none writes.
// Errors    None. Sweeps beyond `most` places are left out.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "stormcellar/level2/volume.h"
#include "web/data/station/sweep_kind.h"

namespace stormcellar::web {

// Gates along the beam: the axis `range`, or the axis of a moment whose gates do not fit to it.
struct GateAxis {
    std::string name;
    std::int32_t first_gate_m = 0, gate_spacing_m = 0;
    std::size_t gates = 0;
};

struct PlacedMoment {
    level2::Moment moment = level2::Moment::ref;
    std::string axis;
};

struct SweepPlace {
    SweepKind kind;
    int occurrence = 0;          // how often the kind came before in a volume
    double fixed_angle_deg = 0;  // of the first sweep that was learned
    std::vector<PlacedMoment> moments = {};
    std::vector<GateAxis> axes = {};

    [[nodiscard]] const GateAxis& axis_of(const PlacedMoment& moment) const;
    [[nodiscard]] std::size_t azimuths() const;  // 360 or 720
};

// Returns how many gates of the axis a gate of the array covers; 0 if the gates do not fit.
[[nodiscard]] int repeats_on(const level2::SweepMoment& array, std::int32_t first_gate_m,
                             std::int32_t gate_spacing_m);

// The number of sweeps of a volume, and how many times 360 radials it has. Volumes of one size
// usually have the same cuts.
using VolumeSize = std::pair<int, long>;
[[nodiscard]] VolumeSize size_of_volume(int sweeps, int radials);

class SweepPlaces {
  public:
    static constexpr std::size_t most = 256;

    // Adds the places, moments and gates of a volume.
    void learn(const level2::Volume& volume, VolumeSize size);

    [[nodiscard]] const std::vector<SweepPlace>& all() const { return places_; }
    // Returns the sweep of a volume that belongs to a place, or null.
    [[nodiscard]] const level2::Sweep* find(const level2::Volume& volume, std::size_t place) const;
    // Returns the elevation number by which volumes of this size have the sweep of a place. Returns
    // none if no such volume was learned, or if the sweeps before it must be counted.
    [[nodiscard]] std::optional<int> cut_of(VolumeSize size, std::size_t place) const;
    // Returns true if the sweep is of the kind of the place, and of no nearer kind.
    [[nodiscard]] bool is_of_place(const level2::Sweep& sweep, std::size_t place) const;

  private:
    struct Cut {
        int elevation_number = 0;
        bool is_first = false;  // of its volume
    };
    // The index in kinds_, and how often the kind came before in the volume.
    using Key = std::pair<std::size_t, int>;

    [[nodiscard]] std::optional<std::size_t> nearest_kind(const SweepKind& kind) const;
    void join(SweepPlace& place, const level2::Sweep& sweep);

    std::vector<SweepKind> kinds_;
    std::vector<SweepPlace> places_;
    std::vector<std::size_t> kind_of_place_;
    std::map<Key, std::size_t> numbers_;
    std::map<std::pair<VolumeSize, std::size_t>, Cut> cuts_;
};

}  // namespace stormcellar::web
