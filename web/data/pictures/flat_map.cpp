#include "web/data/pictures/flat_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "base/parallel.h"
#include "render/color/moment_look.h"
#include "render/options/scene_options.h"
#include "render/products/sweep_field.h"
#include "render/still/map_raster.h"
#include "stormcellar/level2/live_sweep.h"
#include "stormcellar/render/product.h"
#include "web/data/pictures/shown_grid.h"

namespace stormcellar::web {
namespace {

using grid::CellStatus;

constexpr int smallest_side = 32;
constexpr int rows_of_a_band = 32;

enum class Mixing { largest, farthest_from_zero, mean, first };

Mixing mixing_of(const render::Scene& scene) {
    const render::ProductFacts& facts = render::facts_of(scene.product);
    if (!facts.unit.empty()) return Mixing::largest;
    const level2::MomentFacts& moment = level2::facts_of(scene.moment);
    if (moment.circle == level2::Circle::full_turn) return Mixing::first;
    if (moment.is_signed) return Mixing::farthest_from_zero;
    return render::look_of(scene.moment).shows_largest ? Mixing::largest : Mixing::mean;
}

// Collects up to four cells, which become one.
struct CellsTogether {
    std::array<float, 4> values{};
    std::size_t count = 0;  // number of values
    bool is_folded = false, is_ambiguous = false, is_seen = false;

    void add(CellStatus status, float value) {
        if (status == CellStatus::value) values[count++] = value;
        is_folded = is_folded || status == CellStatus::range_folded;
        is_ambiguous = is_ambiguous || status == CellStatus::ambiguous;
        is_seen = is_seen || status != CellStatus::not_seen;
    }
    [[nodiscard]] CellStatus status() const {
        if (count > 0) return CellStatus::value;
        if (is_ambiguous) return CellStatus::ambiguous;
        if (is_folded) return CellStatus::range_folded;
        return is_seen ? CellStatus::no_echo : CellStatus::not_seen;
    }
    [[nodiscard]] float value(Mixing mixing) const {
        const auto* const end = values.begin() + count;
        switch (mixing) {
            case Mixing::largest:
                return *std::max_element(values.begin(), end);
            case Mixing::farthest_from_zero:
                return *std::max_element(values.begin(), end, [](float a, float b) {
                    return std::abs(a) < std::abs(b);
                });
            case Mixing::mean: {
                float sum = 0;
                for (const auto* at = values.begin(); at != end; ++at)
                    sum += *at;
                return sum / static_cast<float>(count);
            }
            case Mixing::first:
                break;
        }
        return values.front();
    }
};

std::string key_of_map(const OpenGrid& grid, const render::Scene& scene) {
    return fmt::format("{}|{}|{}|{}|{}|{}", grid.id, render::product_name(scene.product),
                       scene.cappi_height_m, scene.echo_top_dbz, scene.freezing_levels.zero_c_m,
                       scene.freezing_levels.minus_20_c_m);
}

std::shared_ptr<const FlatMap> map_with_levels(FlatMap map, render::FlatField field,
                                               const render::Scene& scene, int threads) {
    map.at_least = std::exchange(field.at_least, {});
    map.levels.push_back(std::move(field));
    while (std::max(map.levels.back().width, map.levels.back().height) > smallest_side)
        map.levels.push_back(halved_field(map.levels.back(), scene, threads));
    return std::make_shared<const FlatMap>(std::move(map));
}

Result<std::shared_ptr<const FlatMap>> made_map(const std::filesystem::path& cache,
                                                const OpenGrid& grid, const render::Scene& scene,
                                                int threads) {
    const auto shown = shown_grid(cache, grid, scene, threads);
    if (!shown) return pass_on(shown);
    const grid::BrickView view = shown->view();
    const render::FrameFacts facts =
        render::frame_facts_of(grid.domain, shown->description(), "UTC");
    auto field = render::still_field({view, facts, scene}, threads);
    if (!field) return pass_on(field);
    if (Status whole = shown->check_whole(); !whole) return pass_on(whole);
    return map_with_levels({grid.file.description().spec, {}, {}, {}}, std::move(*field), scene,
                           threads);
}

Result<std::shared_ptr<const FlatMap>> made_map(const SweepPicture& picture,
                                                const SweepPictures& sweeps, int threads) {
    auto decoded = sweeps.decode(picture);
    if (!decoded) return pass_on(decoded);
    auto sweep = std::make_shared<const PlacedSweep>(std::move(decoded->front()));
    const grid::GridSpec& spec = sweep->description.spec;
    auto field = render::sweep_in_columns(sweep->sweep, spec, threads);
    return map_with_levels({spec, sweep, {}, {}}, std::move(field),
                           picture.style.panels.front().scene, threads);
}

}  // namespace

std::uint64_t FlatMap::bytes() const {
    std::uint64_t bytes = sizeof(FlatMap) + at_least.size();
    for (const render::FlatField& level : levels)
        bytes += level.values.size() * (sizeof(float) + sizeof(CellStatus));
    if (sweep) {
        for (const level2::Sweep& part : sweep->source->volume.sweeps)
            bytes += level2::bytes_of(part);
    }
    return bytes;
}

render::FlatField halved_field(const render::FlatField& field, const render::Scene& scene,
                               int threads) {
    const Mixing mixing = mixing_of(scene);
    render::FlatField half((field.width + 1) / 2, (field.height + 1) / 2);
    const auto halve_row = [&](int y) {
        const int rows = std::min(2 * y + 2, field.height) - 2 * y;
        for (int x = 0; x < half.width; ++x) {
            const int columns = std::min(2 * x + 2, field.width) - 2 * x;
            CellsTogether cells;
            for (int row = 0; row < rows; ++row) {
                for (int column = 0; column < columns; ++column) {
                    const std::size_t place = field.index(2 * x + column, 2 * y + row);
                    cells.add(field.status[place], field.values[place]);
                }
            }
            const CellStatus status = cells.status();
            half.put(half.index(x, y), status,
                     status == CellStatus::value ? cells.value(mixing) : 0);
        }
    };
    const int bands = (half.height + rows_of_a_band - 1) / rows_of_a_band;
    for_each_piece(bands, threads, [&](int band) {
        const int end = std::min(half.height, (band + 1) * rows_of_a_band);
        for (int y = band * rows_of_a_band; y < end; ++y)
            halve_row(y);
    });
    return half;
}

Result<std::shared_ptr<const FlatMap>> FlatMaps::find_or_make(const OpenGrid& grid,
                                                              const render::Scene& scene,
                                                              int threads) {
    return find_or_make(key_of_map(grid, scene),
                        [&] { return made_map(cache_, grid, scene, threads); });
}

Result<std::shared_ptr<const FlatMap>> FlatMaps::find_or_make(const SweepPicture& picture,
                                                              const SweepPictures& sweeps,
                                                              int threads) {
    return find_or_make(picture.key(), [&] { return made_map(picture, sweeps, threads); });
}

Result<std::shared_ptr<const FlatMap>> FlatMaps::find_or_make(const std::string& key,
                                                              const Make& make) {
    {
        const MutexLock lock(mutex_);
        while (making_.contains(key))
            made_.wait(mutex_);
        if (const auto* kept = maps_.find(key)) return *kept;
        making_.insert(key);
    }
    // Wakes the threads that wait for the map, also if there is no memory for it.
    struct Ending {
        FlatMaps& maps;
        const std::string& key;
        ~Ending() {
            {
                const MutexLock lock(maps.mutex_);
                maps.making_.erase(key);
            }
            maps.made_.notify_all();
        }
    };
    const Ending ending{*this, key};
    auto map = make();
    if (map) {
        const MutexLock lock(mutex_);
        maps_.keep(key, *map, (*map)->bytes());
    }
    return map;
}

}  // namespace stormcellar::web
