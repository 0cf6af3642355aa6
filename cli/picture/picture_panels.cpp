#include "cli/picture/picture_panels.h"

#include <algorithm>

#include <fmt/ranges.h>

#include "cli/shared/commands.h"
#include "stormcellar/render/panels.h"

namespace stormcellar::cli {
namespace {

std::vector<PictureGrid> nothing_matched(const cache::StoreReader& store, const std::string& why) {
    fmt::print(stderr, "stormcellar: {}\n",
               printable(fmt::format("{}: {}", store.directory().native(), why)));
    return {};
}

// Removes the options of derived moments that none of these moments uses.
void keep_used(GridOptions& options, const std::vector<level2::Moment>& moments) {
    if (std::ranges::none_of(moments, level2::is_dealiased)) options.dealias.clear();
    const bool has_srv = std::ranges::find(moments, level2::Moment::srv) != moments.end();
    if (!has_srv) options.storm_motion.clear();
}

// Returns the sweep of each moment, on the plane of the first sweep.
Result<std::vector<PictureGrid>> swept_panels(const GridOptions& all,
                                              const std::vector<PanelScene>& panels) {
    std::vector<PictureGrid> sweeps;
    for (const PanelScene& panel : panels) {
        GridOptions options = all;
        options.moment = level2::moment_name(panel.moment);
        keep_used(options, {panel.moment});
        auto volume = read_sweeps(options, &panel.scene);
        if (!volume) return pass_on(volume);
        const grid::GridSpec* const plane =
            sweeps.empty() ? nullptr : &sweeps.front().description().spec;
        auto sweep = PictureGrid::of_sweep(std::move(*volume), panel.scene, plane);
        if (!sweep) return pass_on(sweep);
        sweeps.push_back(std::move(*sweep));
    }
    return sweeps;
}

}  // namespace

Result<std::vector<PanelScene>> panel_scenes(const std::string& list, const SceneFile& file,
                                             const SceneOptions& options) {
    return render::panel_scenes(list, options,
                                [&](const SceneOptions& panel) { return scene_with(file, panel); });
}

Result<std::vector<PictureGrid>> stored_panels(const cache::StoreReader& store,
                                               const std::string& domain,
                                               const std::vector<PanelScene>& panels,
                                               std::optional<UtcTime> until) {
    std::vector<std::vector<cache::StoreEntry>> kept;
    for (const PanelScene& panel : panels) {
        auto entries = store.list(domain, panel.moment, std::nullopt, until);
        if (!entries) return pass_on(entries);
        if (!until) cache::leave_out_future(*entries, now_utc());
        if (entries->empty()) {
            return nothing_matched(store, fmt::format("there is no grid of {} of domain '{}'",
                                                      level2::moment_name(panel.moment), domain));
        }
        kept.push_back(std::move(*entries));
    }
    const auto find_at = [](const std::vector<cache::StoreEntry>& entries, UtcTime time) {
        return std::ranges::find(entries, time, &cache::StoreEntry::time);
    };
    const auto& first = kept.front();
    const auto common = std::find_if(first.rbegin(), first.rend(), [&](const auto& entry) {
        return std::ranges::all_of(kept, [&](const auto& entries) {
            return find_at(entries, entry.time) != entries.end();
        });
    });
    if (common == first.rend()) {
        return nothing_matched(
            store,
            fmt::format("domain '{}' has no time of which all moments of the panels are there",
                        domain));
    }
    std::vector<PictureGrid> grids;
    for (const auto& entries : kept) {
        auto grid = PictureGrid::open(find_at(entries, common->time)->path);
        if (!grid) return pass_on(grid);
        grids.push_back(std::move(*grid));
    }
    return grids;
}

Result<std::vector<PictureGrid>> gridded_panels(GridOptions options,
                                                const std::vector<PanelScene>& panels) {
    if (render::facts_of(panels.front().scene.product).is_of_sweep)
        return swept_panels(options, panels);
    std::vector<std::string_view> names;
    std::vector<level2::Moment> moments;
    for (const PanelScene& panel : panels) {
        names.push_back(level2::moment_name(panel.moment));
        moments.push_back(panel.moment);
    }
    keep_used(options, moments);
    options.moment = fmt::format("{}", fmt::join(names, ","));
    options.takes_moments = true;
    auto made = PictureGrid::make_each(std::move(options));
    if (!made) return made;
    std::vector<PictureGrid> grids;
    for (const PanelScene& panel : panels) {
        const auto of_moment = std::ranges::find_if(*made, [&](const PictureGrid& grid) {
            return grid.has_grid() && grid.description().moment == panel.moment;
        });
        if (of_moment == made->end()) {
            return fail(ErrorCode::not_found, "there is no {} in the files",
                        level2::moment_name(panel.moment));
        }
        grids.push_back(std::move(*of_moment));
    }
    return grids;
}

Result<render::Image> draw_panels(const std::string& domain, const std::vector<PanelScene>& panels,
                                  const std::vector<PictureGrid>& grids,
                                  const SceneOptions& options) {
    std::vector<render::Panel> drawn;
    for (std::size_t i = 0; i < panels.size(); ++i) {
        drawn.push_back({grids[i].view(),
                         frame_facts_of(domain, grids[i].description(), options.time_zone),
                         panels[i].scene});
    }
    auto picture = render::render_panels(drawn, render::thread_count(options));
    if (!picture) return picture;
    for (const PictureGrid& grid : grids) {
        if (Status whole = grid.check_whole(); !whole) return pass_on(whole);
    }
    return picture;
}

}  // namespace stormcellar::cli
