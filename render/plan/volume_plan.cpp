#include "render/plan/volume_plan.h"

#include <algorithm>
#include <chrono>

#include "accuracy/governor.h"
#include "render/color/color_difference.h"
#include "render/image/shades.h"
#include "stormcellar/accuracy/candidate.h"

namespace stormcellar::render {
namespace {

using accuracy::Chain;
using accuracy::Choice;
using accuracy::with_rung;

Result<double> difference(const Image& one, const Image& other) {
    const auto found = image_difference(one, other);
    if (!found) return pass_on(found);
    return found->percentile_99;
}

}  // namespace

VolumeScene::VolumeScene(const grid::BrickView& view, const ColorTable& table, const Scene& scene,
                         int width, int height, int threads)
    : view_(view),
      table_(table),
      scene_(scene),
      width_(width),
      height_(height),
      threads_(threads) {}

const VolumeScene::Drawn& VolumeScene::draw(const VolumeChoice& choice) {
    const auto known = std::find_if(drawn_.begin(), drawn_.end(),
                                    [&](const auto& one) { return one.first == choice; });
    if (known != drawn_.end()) return known->second;
    Light light = scene_.light;
    light.gradient = choice.gradient;
    light.shadow = choice.shadow;
    light.scattering = choice.scattering;
    const auto start = std::chrono::steady_clock::now();
    const ViewGeometry geometry(*view_.spec, scene_.camera, scene_.vertical_exaggeration, width_,
                                height_, scene_.curved_earth);
    const VolumeSlicer slicer(table_, view_.quantization, geometry,
                              {choice.slices, choice.integration, scene_.opacity,
                               choice.every_pixel ? 0 : interpolated_tolerance, light});
    Drawn drawn{Image(width_, height_, shades_of(scene_.theme).page), 0};
    composite_over(slicer.draw(view_, threads_), drawn.picture, 0, 0);
    drawn.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return drawn_.emplace_back(choice, std::move(drawn)).second;
}

Status predict(VolumeScene& scene, Chain& chain, Predicted which) {
    const Choice exact = accuracy::exact_choice(chain);
    for (std::size_t i = 0; i < chain.steps.size(); ++i) {
        for (std::size_t k = 0; k < chain.steps[i].effects.size(); ++k) {
            accuracy::Effect& effect = chain.steps[i].effects[k];
            if (effect.setting == accuracy::Setting::not_asked && which == Predicted::asked) {
                continue;
            }
            const auto& without = scene.draw(volume_choice(chain, with_rung(exact, i, k)));
            const auto& with = scene.draw(volume_choice(chain, with_rung(exact, i, k + 1)));
            const auto size = difference(without.picture, with.picture);
            if (!size) return pass_on(size);
            effect.predicted.image_de = *size;
            effect.cost_s = std::max(0.0, with.seconds - without.seconds);
        }
    }
    Choice cheapest = exact;
    for (std::size_t& rung : cheapest.rungs)
        rung = 0;
    chain.cheapest_cost_s = scene.draw(volume_choice(chain, cheapest)).seconds;
    return {};
}

Result<VolumePlan> plan_volume(VolumeScene& scene, Chain chain,
                               const std::optional<accuracy::Budget>& budget,
                               const VolumeChoice& by_default, Predicted which) {
    if (budget && (budget->position_m || budget->value)) {
        return fail(ErrorCode::bad_argument,
                    "the tolerance of a picture must be a color difference (\"dE 2\") or a time");
    }
    if (auto done = predict(scene, chain, which); !done) return pass_on(done);
    const auto measure = [&](const Choice& choice) -> Result<accuracy::Measured> {
        const Image& exact =
            scene.draw(volume_choice(chain, accuracy::exact_choice(chain))).picture;
        const auto off = difference(scene.draw(volume_choice(chain, choice)).picture, exact);
        if (!off) return pass_on(off);
        accuracy::Measured measured;
        measured.image_de = *off;
        return measured;
    };
    auto plan = accuracy::govern_or_default(chain, budget, rungs_of(chain, by_default), measure);
    if (!plan) return pass_on(plan);
    // The default may have a number of slices that is between two rungs.
    const VolumeChoice choice = budget ? volume_choice(chain, plan->choice) : by_default;
    return VolumePlan{std::move(*plan), choice};
}

Result<std::vector<accuracy::LadderRow>> run_ladder(VolumeScene& scene, const Chain& chain) {
    const Choice exact = accuracy::exact_choice(chain);
    const Image& truth = scene.draw(volume_choice(chain, exact)).picture;
    std::vector<accuracy::LadderRow> rows;
    for (std::size_t i = 0; i < chain.steps.size(); ++i) {
        if (exact.rungs[i] == 0) continue;  // the scene asks for no effect of this step
        for (std::size_t k = 0; k <= exact.rungs[i]; ++k) {
            const auto& drawn = scene.draw(volume_choice(chain, with_rung(exact, i, k)));
            const auto off = difference(drawn.picture, truth);
            if (!off) return pass_on(off);
            accuracy::LadderRow row;
            row.step = chain.steps[i].name;
            row.rung = k;
            row.name = chain.steps[i].rung_name(k);
            row.time_s = drawn.seconds;
            row.image_p99_de = *off;
            rows.push_back(std::move(row));
        }
    }
    accuracy::mark_pareto(rows);
    return rows;
}

}  // namespace stormcellar::render
