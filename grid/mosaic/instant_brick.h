// grid/mosaic/instant_brick.h -- makes one brick of a grid for an instant between two volumes.
//
// Only code inside grid/ uses this. grid/mosaic/time_interpolation.h defines the result.
//
// Threads   An InstantMaker is immutable, and threads share it. One thread at a time may use an
//           InstantBrick.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "grid/beam/detection_limit.h"
#include "grid/cells/code_block.h"
#include "grid/mosaic/time_interpolation.h"
#include "grid/sweep/mixture.h"

namespace stormcellar::grid {

// The data that all bricks share. An End is one of the two volumes.
class InstantMaker {
  public:
    InstantMaker(const TimedView& before, const std::optional<TimedView>& after,
                 const ColumnGeometry& geometry, const InstantOptions& options);

  private:
    friend class InstantBrick;
    struct End {
        TimedView timed;
        double middle_s = 0;  // middle of the volume relative to the instant; negative if earlier
        std::optional<SweepClock> clock;
    };
    static End end_of(const TimedView& timed, const ColumnGeometry& geometry,
                      const InstantOptions& options);

    std::vector<End> ends_;  // one or two volumes, in order of time
    const ColumnGeometry* geometry_;
    InstantOptions options_;
    Blending blending_;
    bool has_classes_;  // which are not mixed
    DetectionLimit limit_;
    bool moves_;
};

class InstantBrick {
  public:
    InstantBrick(const InstantMaker& maker, int bx, int by);

    // Writes the brick at height `bz` (counted in bricks).
    void write(int bz, BricksWriter& writer);

  private:
    static constexpr std::size_t columns = static_cast<std::size_t>(brick_edge) * brick_edge;
    // The data of one end for the bricks at one height.
    struct Source {
        CodeBlock codes;
        // The time of each cell relative to the instant, for all heights of the columns. Empty if
        // the volume has no clock.
        std::vector<float> column_seconds;
        std::array<float, brick_cells> seconds;
        ColumnBox box;
        bool is_still = true;  // no column has moved
    };

    // Returns the common status of all cells if it is known without reading a cell. Otherwise fills
    // codes_.
    std::optional<CellStatus> make(int bz);
    void read_times(std::size_t end);
    void take_times(std::size_t end, int bz);
    void find_box(std::size_t end);
    void fill();
    [[nodiscard]] Sample sample(std::size_t end, std::size_t cell);
    [[nodiscard]] Sample mix(const Source& source, double x, double y, std::size_t cell);
    [[nodiscard]] Sample sample_of(std::uint16_t code) const;
    [[nodiscard]] Sample with_limit(Sample sample, std::size_t cell);
    [[nodiscard]] float weight_of_after(std::size_t cell) const;
    [[nodiscard]] std::uint16_t code_of(const CellResult& cell) const;

    const InstantMaker& maker_;
    int bx_, by_;
    int bz_ = 0;
    std::array<CellMotion, columns> motion_{};
    std::array<float, columns> arc_m_{};
    std::array<Source, 2> sources_;
    std::array<float, brick_cells> limits_{};  // dBZ; NaN: not computed yet
    std::array<std::uint16_t, brick_cells> codes_{};
};

}  // namespace stormcellar::grid
