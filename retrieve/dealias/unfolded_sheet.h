// retrieve/dealias/unfolded_sheet.h -- the velocities of a sheet with their fold numbers, and where
// neighboring gates differ.
//
// Most neighbors are alike. Marks for runs of 16 gates let later steps skip the runs in which all
// gates are alike.
//
// Units     Turns, as in velocity_sheet.h.
// Threads   Plain data.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "retrieve/dealias/velocity_sheet.h"

namespace stormcellar::retrieve {

class UnfoldedSheet {
  public:
    static constexpr int run_gates = 16;
    // A difference above this is rough; above half a turn it is a jump.
    static constexpr float rough_turns = 0.125F, jump_turns = 0.5F;

    UnfoldedSheet(const VelocitySheet& sheet, const std::vector<std::int8_t>& folds);

    // Returns the velocities of a radial. After its last gate there is at least one NaN, which
    // means no value.
    [[nodiscard]] const float* row(int radial) const {
        return turns_.data() + static_cast<std::size_t>(radial) * stride_;
    }
    // Returns the row of the radial beside this one, or a row without values if there is none.
    [[nodiscard]] const float* row_after(int radial) const { return row(after(radial)); }
    // Returns the number of the radial beside this one, or the number of radials if there is none.
    [[nodiscard]] int after(int radial) const {
        if (radial + 1 < radials_) return radial + 1;
        return is_circle_ ? 0 : radials_;
    }
    [[nodiscard]] int runs() const { return runs_; }
    // Returns a mark for each run of gates of a radial: 2 if a gate of the run and the next gate of
    // its radial, or the gate beside it in the next radial, differ by a jump; else 1 if a gate and
    // the next gate of its radial differ roughly; else 0.
    [[nodiscard]] const std::uint8_t* marks(int radial) const {
        return marks_.data() + static_cast<std::size_t>(radial) * static_cast<std::size_t>(runs_);
    }
    [[nodiscard]] bool jumps(int radial, int run) const { return marks(radial)[run] > 1; }

  private:
    void mark_runs(int radial);

    int radials_, runs_;
    bool is_circle_;
    std::size_t stride_;
    std::vector<float> turns_;         // (radials + 1) x stride
    std::vector<std::uint8_t> marks_;  // radials x runs: see marks()
};

}  // namespace stormcellar::retrieve
