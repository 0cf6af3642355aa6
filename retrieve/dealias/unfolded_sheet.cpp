#include "retrieve/dealias/unfolded_sheet.h"

#include <limits>

namespace stormcellar::retrieve {

UnfoldedSheet::UnfoldedSheet(const VelocitySheet& sheet, const std::vector<std::int8_t>& folds)
    : radials_(sheet.radials),
      runs_((sheet.gates + run_gates - 1) / run_gates),
      is_circle_(sheet.is_circle),
      stride_(static_cast<std::size_t>(runs_ * run_gates + 1)),
      turns_(static_cast<std::size_t>(radials_ + 1) * stride_,
             std::numeric_limits<float>::quiet_NaN()),
      marks_(static_cast<std::size_t>(radials_) * static_cast<std::size_t>(runs_)) {
    for (int radial = 0; radial < radials_; ++radial) {
        const float* from = sheet.row(radial);
        const std::int8_t* fold = folds.data() + sheet.at(radial, 0);
        float* to = turns_.data() + static_cast<std::size_t>(radial) * stride_;
        for (int gate = 0; gate < sheet.gates; ++gate)
            to[gate] = from[gate] + static_cast<float>(fold[gate]);
    }
    for (int radial = 0; radial < radials_; ++radial)
        mark_runs(radial);
}

// Counts in whole numbers without branches, so that the compiler handles several gates at once.
void UnfoldedSheet::mark_runs(int radial) {
    const float* here = row(radial);
    const float* beside = row_after(radial);
    for (int run = 0; run < runs_; ++run, here += run_gates, beside += run_gates) {
        int rough = 0, jumps = 0;
        for (int gate = 0; gate < run_gates; ++gate) {
            const float along = turns_apart(here[gate], here[gate + 1]);
            const float across = turns_apart(here[gate], beside[gate]);
            rough += along > rough_turns ? 1 : 0;
            jumps += (along > jump_turns ? 1 : 0) + (across > jump_turns ? 1 : 0);
        }
        const int mark = jumps > 0 ? 2 : rough > 0 ? 1 : 0;
        marks_[static_cast<std::size_t>(radial * runs_ + run)] = static_cast<std::uint8_t>(mark);
    }
}

}  // namespace stormcellar::retrieve
