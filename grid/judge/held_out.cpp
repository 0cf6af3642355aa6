#include "grid/judge/held_out.h"

#include <algorithm>
#include <array>
#include <chrono>

#include "grid/cells/code_block.h"

namespace stormcellar::grid {
namespace {

using Clock = std::chrono::steady_clock;

constexpr float counted_dbz = 5;
constexpr float strong_dbz = 20;
constexpr float weak_dbz = 10;

class Comparison {
  public:
    Comparison(const BrickView& made, const BrickView& seen) : made_(made), seen_(seen) {}

    void run() {
        for (int bx = 0; bx < made_.bricks_x; ++bx) {
            for (int by = 0; by < made_.bricks_y; ++by) {
                for (int bz = 0; bz < made_.bricks_z; ++bz)
                    compare_brick(bx, by, bz);
            }
        }
    }
    [[nodiscard]] bool is_empty() const { return errors_.empty(); }
    [[nodiscard]] HeldOutScore score(TimeMethod method, double seconds) const {
        HeldOutScore score;
        score.method = method;
        score.seconds = seconds;
        score.error = accuracy::summarize(errors_).value_or(accuracy::ErrorSummary{});
        for (const double error : errors_)
            score.mean_db += error / static_cast<double>(errors_.size());
        const auto share = [](std::size_t part, std::size_t whole) {
            return whole == 0 ? 0 : static_cast<double>(part) / static_cast<double>(whole);
        };
        score.echo_missed = share(missed_, strong_seen_);
        score.echo_invented = share(invented_, strong_made_);
        return score;
    }

  private:
    void compare_brick(int bx, int by, int bz) {
        const ColumnBox box{bx * brick_edge, by * brick_edge, (bx + 1) * brick_edge - 1,
                            (by + 1) * brick_edge - 1};
        const bool both_uniform = CodeBlock::uniform_status(made_, box, bz).has_value() &&
                                  CodeBlock::uniform_status(seen_, box, bz).has_value();
        if (both_uniform) return;
        made_codes_.read(made_, box, bz);
        seen_codes_.read(seen_, box, bz);
        for (int ix = box.x0; ix <= box.x1; ++ix) {
            for (int iy = box.y0; iy <= box.y1; ++iy) {
                for (int z = 0; z < brick_edge; ++z)
                    compare_cell(made_codes_.column(ix, iy)[z], seen_codes_.column(ix, iy)[z]);
            }
        }
    }

    static bool is_seen(std::uint16_t code) {
        return code >= first_value_code || code == static_cast<std::uint16_t>(CellStatus::no_echo);
    }
    void compare_cell(std::uint16_t made_code, std::uint16_t seen_code) {
        if (!is_seen(made_code) || !is_seen(seen_code)) return;
        const float made = dbz_of(made_, made_code), seen = dbz_of(seen_, seen_code);
        if (std::max(made, seen) < counted_dbz) return;
        errors_.push_back(static_cast<double>(made - seen));
        if (seen >= strong_dbz) {
            ++strong_seen_;
            missed_ += made < weak_dbz ? 1 : 0;
        }
        if (made >= strong_dbz) {
            ++strong_made_;
            invented_ += seen < weak_dbz ? 1 : 0;
        }
    }
    static float dbz_of(const BrickView& view, std::uint16_t code) {
        return code < first_value_code ? 0 : std::max(0.0F, view.quantization.value_of(code));
    }

    const BrickView &made_, &seen_;
    CodeBlock made_codes_, seen_codes_;
    std::vector<double> errors_;
    std::size_t strong_seen_ = 0, missed_ = 0, strong_made_ = 0, invented_ = 0;
};

}  // namespace

Result<HeldOut> score_held_out(const TimedView& before, const TimedView& held_out,
                               const TimedView& after, const ColumnGeometry& geometry,
                               int threads) {
    HeldOut result;
    for (const TimeMethodFacts& facts : time_method_facts) {
        const TimeMethod method = facts.method;
        const auto start = Clock::now();
        InstantOptions options{.instant = held_out.middle, .method = method};
        // The held-out volume also took minutes. Without sweep times, a reconstructed cell is
        // compared with a cell that has about the same time within its volume.
        options.sweep_times = false;
        options.threads = threads;
        std::optional<MotionField> motion;
        if (method == TimeMethod::advected) {
            MotionOptions motion_options{.threads = threads};
            auto found =
                estimate_motion(before.view, after.view,
                                seconds_between(before.middle, after.middle), motion_options);
            if (!found) return pass_on(found);
            motion = std::move(*found);
        }
        if (motion) {
            options.motion = &*motion;
            const GridSpec& spec = geometry.spec();
            const CellMotion cells = motion->whole();
            result.motion_mps = CellMotion{cells.x * static_cast<float>(spec.cell_width_m()),
                                           cells.y * static_cast<float>(spec.cell_height_m())};
        }
        const auto made = grid_at(before, after, geometry, options);
        if (!made) return pass_on(made);
        const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
        const BrickView view = made->view();
        Comparison comparison(view, held_out.view);
        comparison.run();
        if (comparison.is_empty()) {
            return fail(ErrorCode::not_found, "there is no echo of 5 dBZ or more to compare");
        }
        result.scores.push_back(comparison.score(method, seconds));
    }
    return result;
}

}  // namespace stormcellar::grid
