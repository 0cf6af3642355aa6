// grid/beam/arc_table.h -- a table of a function of the arc, with a step of 500 m, and linear in
// between.
//
// Threads   Immutable.
// Accuracy  The error is half the second derivative of the function times 250 m squared
//           (tests/grid/sweep_mixture_test.cpp). Each user of a table states its own error in
//           meters.
#pragma once

#include <cstddef>
#include <vector>

namespace stormcellar::grid {

// The place of an arc in an ArcTable.
struct ArcPlace {
    std::size_t index = 0;
    float fraction = 0;
};

class ArcTable {
  public:
    static constexpr double step_m = 500;

    ArcTable() = default;
    // Calls at(arc) for each arc of the table, in meters, and stores the values.
    template <class Function>
    ArcTable(std::size_t size, Function at) {
        values_.reserve(size);
        for (std::size_t i = 0; i < size; ++i)
            values_.push_back(static_cast<float>(at(step_m * static_cast<double>(i))));
    }
    [[nodiscard]] float at(ArcPlace place) const {
        const float here = values_[place.index];
        return here + place.fraction * (values_[place.index + 1] - here);
    }
    // Returns the value at the arc index * step_m.
    [[nodiscard]] float operator[](std::size_t index) const { return values_[index]; }
    // Returns the place of an arc, which must be at least 0. at() needs a table that has more than
    // index + 1 entries.
    [[nodiscard]] static ArcPlace place_of(float arc_m) {
        const float along = arc_m / static_cast<float>(step_m);
        const auto index = static_cast<std::size_t>(along);
        return {index, along - static_cast<float>(index)};
    }
    [[nodiscard]] std::size_t size() const { return values_.size(); }

  private:
    std::vector<float> values_;
};

}  // namespace stormcellar::grid
