// pipeline/ingest/living_sweeps.h -- the sweeps for the living grids of a growing volume, unpacked
// once for all moments.
//
// Velocities are dealiased sweep by sweep: each sweep once, anchored to the sweeps of its volume
// that came before it and to the site's last volume. A complete volume is dealiased as a whole, and
// alone, so its final grid does not depend on what came before. Living VELD differs from the final
// VELD at up to 0.1 % of the gates by whole folds, and 0.5 % are ambiguous in one of the two
// (stormcellar/retrieve/dealias.h; a sweep that is anchored to a wrong sweep can differ more). The
// sweeps of the last volume have its final VELD.
//
// Echo that is probably not weather is left out sweep by sweep, too (DerivedOptions::quality). A
// sweep with dual polarization is judged by its own moments. Every other sweep is judged by the
// sweep of the same angle that came before it. With dual polarization, the final grid leaves out
// the same echo. Without dual polarization, a growing volume lacks the sweep above, and the
// velocities of a surveillance cut; 7.5 % of the echo of a rainy volume is judged otherwise than in
// the final grid (tests/pipeline/wanted_echo_test.cpp).
//
// Threads   One thread at a time.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "pipeline/ingest/followed_file.h"
#include "stormcellar/retrieve/derived_moments.h"

namespace stormcellar::pipeline {

class LivingSweeps {
  public:
    // Reads the sweeps of the growing volume that have one of these moments, and the sweeps of the
    // site's last volume (null: none) that the growing volume has not yet replaced. For derived
    // moments, dealiases the sweeps that were not dealiased since they came or changed. Keeps the
    // result, and the shear that is gridded, with the sweep's volume. The volumes need not outlive
    // the object. Errors: those of the shelf.
    [[nodiscard]] static Result<LivingSweeps> read(const ShelvedVolume& growing,
                                                   const ShelvedVolume* last, MomentSet moments,
                                                   const retrieve::DerivedOptions& options);

    // Returns the growing volume's sweeps that have the moment, preceded by the last volume's
    // sweeps that have it and whose elevation has not come again (within 0.2 degrees). Because only
    // sweeps with the moment count, an old Doppler sweep stays until a new Doppler sweep has come.
    // If the last volume is more than 20 minutes older, its sweeps are left out. For a moment that
    // comes from velocities, the sweeps have only velocities and VELD. The result is valid until
    // the next call.
    [[nodiscard]] level2::Volume& volume_of(level2::Moment moment);
    // Returns how many sweeps of the last result of volume_of() are from the last volume.
    [[nodiscard]] std::size_t standing() const { return standing_; }
    // Returns the echo that was left out of these sweeps.
    [[nodiscard]] const retrieve::LeftOutEcho& left_out() const { return left_out_; }
    // Returns how many sweeps read() has dealiased.
    [[nodiscard]] int dealiased() const { return dealiased_; }

  private:
    struct One {
        level2::Sweep sweep;
        MomentSet moments;    // moments for which the sweep counts
        bool stands = false;  // the sweep is from the last volume
        retrieve::LeftOutEcho left_out;
    };
    explicit LivingSweeps(const retrieve::DerivedOptions& options) : options_(options) {}
    // Adds a sweep of the growing volume, or with `stands`, of the last volume. `last` anchors it.
    Status add(const ShelvedVolume& from, ShelvedVolume::SweepKey key, MomentSet moments,
               bool stands, const ShelvedVolume* last);
    // Returns the sweep without the echo that is to be left out.
    [[nodiscard]] Result<level2::Sweep> wanted_echo(const ShelvedVolume& from,
                                                    ShelvedVolume::SweepKey key) const;
    [[nodiscard]] Result<level2::Sweep> dealiased_sweep(const ShelvedVolume& from,
                                                        ShelvedVolume::SweepKey key,
                                                        const ShelvedVolume* last);

    retrieve::DerivedOptions options_;
    int dealiased_ = 0;
    std::vector<One> sweeps_;        // in the order of the volume
    std::vector<std::size_t> lent_;  // indices of the sweeps that are in volume_ now
    level2::Volume volume_;
    std::size_t standing_ = 0;
    retrieve::LeftOutEcho left_out_;
};

}  // namespace stormcellar::pipeline
