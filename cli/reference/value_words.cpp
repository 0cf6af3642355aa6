#include "cli/reference/value_words.h"

#include <algorithm>
#include <array>

#include "grid/mosaic/time_interpolation.h"
#include "grid/plan/grid_effects.h"
#include "pipeline/mosaic/mosaic_effects.h"
#include "render/color/built_in_tables.h"
#include "render/options/scene_options.h"
#include "render/plan/volume_effects.h"
#include "stormcellar/grid/cell_details.h"
#include "stormcellar/grid/grid_spec.h"
#include "stormcellar/grid/method.h"
#include "stormcellar/grid/mosaic.h"
#include "stormcellar/level2/moment.h"
#include "stormcellar/render/product.h"
#include "stormcellar/render/still.h"
#include "stormcellar/render/theme.h"
#include "stormcellar/render/units.h"

namespace stormcellar::cli {
namespace {

using Names = std::vector<std::string>;

template <class Rows>
Names row_names(const Rows& rows) {
    Names names;
    for (const auto& row : rows)
        names.emplace_back(row.name);
    return names;
}

// The values that completions offer.
namespace offered {

Names products() {
    return row_names(render::all_products());
}
Names moments() {
    return row_names(level2::moment_facts);
}
Names dealiasings() {
    return {"off", "auto", "profile", "region", "anchored"};
}
Names motions() {
    return {"auto", "right", "left", "mean"};
}
Names colors() {
    return row_names(render::built_in_tables());
}
Names projections() {
    Names names;
    for (const grid::ProjectionFacts& facts : grid::projection_facts) {
        names.emplace_back(facts.name);
        for (const std::string_view shorter : facts.short_names) {
            if (!shorter.empty()) names.emplace_back(shorter);
        }
    }
    return names;
}
Names overlaps() {
    return row_names(grid::overlap_facts);
}
Names time_methods() {
    return row_names(grid::time_method_facts);
}
Names methods() {
    Names names = row_names(grid::interpolation_facts);
    names.emplace_back("area");
    return names;
}
Names averagings() {
    return {"dB", "Z"};
}
Names profiles() {
    return {"exponential", "standard"};
}
Names kinds_of_light() {
    return {"gradient", "shadow", "scattering", "none"};
}
Names fields() {
    Names names{"all", "counts", "weights"};
    for (const grid::Detail detail : grid::all_details)
        names.emplace_back(grid::detail_name(detail));
    return names;
}

Names groups_of_time() {
    return {"hour", "month", "all"};
}
Names engines() {
    return {"slurm", "make", "local"};
}
Names smoothings() {
    return {"cubic", "none"};
}
Names overlays_of_pictures() {
    return {std::string(render::overlay_cells)};
}
Names units() {
    return row_names(render::all_units());
}
Names themes() {
    return {std::string(render::theme_name(render::Theme::dark)),
            std::string(render::theme_name(render::Theme::light))};
}
Names tiff_contents() {
    return row_names(render::tiff_contents);
}

// Returns each effect of the chains once, with the settings that it may have.
Names settings_of(const std::vector<accuracy::Chain>& chains) {
    Names names;
    for (const accuracy::Chain& chain : chains) {
        for (const std::string& effect : accuracy::effect_names(chain)) {
            for (const char* setting : {"=on", "=off", "=auto"}) {
                if (std::ranges::find(names, effect + setting) == names.end())
                    names.push_back(effect + setting);
            }
        }
    }
    return names;
}
Names effects_of_grids() {
    std::vector<accuracy::Chain> chains;
    for (const level2::Moment moment : level2::all_moments) {
        chains.push_back(grid::effects_of(moment));
        chains.push_back(pipeline::mosaic_effects_of(moment, grid::Averaging::in_db,
                                                     grid::default_overlap(moment)));
    }
    return settings_of(chains);
}
Names effects_of_pictures() {
    return settings_of({render::volume_chain()});
}

}  // namespace offered

constexpr auto value_word_rows = std::to_array<ValueWord>({
    // Options and arguments that name something.
    {"DOMAIN", "DOMAIN", Kept::domains},
    {"--domain", "DOMAIN", Kept::domains},
    // `frame` accepts files as well as domains, so offer both.
    {"FILE", "FILE", Kept::domains, nullptr, "frame"},
    {"FILE", "FILE", Kept::domains, nullptr, "loop"},
    {"--station", "STATION", Kept::stations},
    {"--stations", "STATIONS", Kept::stations},
    {"COMMAND", "COMMAND", Kept::commands},
    {"--product", "PRODUCT", Kept::nowhere, offered::products},
    {"--moment", "MOMENT", Kept::nowhere, offered::moments},
    {"--dealias", "RUNG", Kept::nowhere, offered::dealiasings},
    {"--storm-motion", "MOTION", Kept::nowhere, offered::motions},
    {"--quality", "P"},
    {"--colors", "TABLE", Kept::files, offered::colors},
    {"--projection", "PROJECTION", Kept::nowhere, offered::projections},
    {"--overlap", "RULE", Kept::nowhere, offered::overlaps},
    {"--time-method", "METHOD", Kept::nowhere, offered::time_methods},
    {"--method", "METHOD", Kept::nowhere, offered::methods},
    {"--averaging", "UNIT", Kept::nowhere, offered::averagings},
    {"--profile", "PROFILE", Kept::files, offered::profiles},
    {"--light", "KINDS", Kept::nowhere, offered::kinds_of_light},
    {"--fields", "FIELDS", Kept::nowhere, offered::fields},
    {"--effect", "NAME=on|off|auto", Kept::nowhere, offered::effects_of_grids},
    {"--effect", "NAME=on|off|auto", Kept::nowhere, offered::effects_of_pictures, "frame"},
    {"--effect", "NAME=on|off|auto", Kept::nowhere, offered::effects_of_pictures, "loop"},
    {"--tolerance", "LIMITS"},
    // Options and arguments for files and directories.
    {"--output", "FILE", Kept::files},
    {"--output", "DIRECTORY", Kept::directories, nullptr, "fetch"},
    {"--output", "DIRECTORY", Kept::directories, nullptr, "synth"},
    {"--output", "DIRECTORY", Kept::directories, nullptr, "catalog get"},
    {"--to", "FORMAT", Kept::nowhere, nullptr, "cells"},
    {"--format", "FORMAT"},
    {"--to", "FILE", Kept::files, nullptr, "info"},
    {"--plot", "FILE", Kept::files},
    {"--scene", "FILE", Kept::files},
    {"--config", "FILE", Kept::files},
    {"--socket", "FILE", Kept::files},
    {"--cache", "DIRECTORY", Kept::directories},
    {"--catalog", "DIRECTORY", Kept::directories},
    {"--state", "DIRECTORY", Kept::directories},
    {"--drop", "DIRECTORY", Kept::directories},
    {"--source", "ADDRESS"},
    {"--source", "DIRECTORY", Kept::directories, nullptr, "batch plan"},
    {"--output", "DIRECTORY", Kept::directories, nullptr, "batch plan"},
    {"--plan", "DIRECTORY", Kept::directories},
    {"--program", "FILE", Kept::files},
    {"--engine", "ENGINE", Kept::nowhere, offered::engines},
    {"--by", "GROUP", Kept::nowhere, offered::groups_of_time},
    {"--task", "NUMBER"},
    {"--mosaic", "NAME"},
    {"--partition", "NAME"},
    // Options for times.
    {"--time", "TIME"},
    {"--from", "TIME"},
    {"--to", "TIME"},
    {"--time-zone", "ZONE"},
    {"--interval", "TIME", Kept::nowhere, nullptr, "loop"},
    {"--interval", "TIME", Kept::nowhere, nullptr, "batch plan"},
    {"--interval", "SECONDS", Kept::nowhere, nullptr, "replay"},
    {"--dwell", "SECONDS"},
    {"--older-than", "HOURS"},
    {"--bytes", "SIZE"},
    {"--faults", "FAULTS"},
    // Options for places and sizes.
    {"--center", "PLACE"},
    {"--at", "PLACE"},
    {"--position", "LAT,LON,HEIGHT"},
    {"--near", "LAT,LON"},
    {"--mean-wind", "EAST,NORTH"},
    {"--bounds", "WEST,SOUTH,EAST,NORTH"},
    {"--parallels", "LAT1,LAT2"},
    {"--section", "PLACE;PLACE"},
    {"--probe", "X,Y"},
    {"--probe-at", "PLACE"},
    {"--camera-km", "EAST,NORTH,UP"},
    {"--look-at-km", "EAST,NORTH,UP"},
    {"--theme", "THEME", Kept::nowhere, offered::themes},
    {"--units", "UNITS", Kept::nowhere, offered::units},
    {"--smooth", "HOW", Kept::nowhere, offered::smoothings},
    {"--overlay", "WHAT", Kept::nowhere, offered::overlays_of_pictures},
    {"--geotiff", "CONTENT", Kept::nowhere, offered::tiff_contents},
    {"--panels", "MOMENTS", Kept::nowhere, offered::moments},
    {"--sun", "AZIMUTH,ELEVATION"},
    {"--extent-km", "WIDTH,HEIGHT"},
    {"--extent-deg", "WIDTH,HEIGHT"},
    {"--levels-km", "HEIGHTS"},
    {"--surfaces", "VALUES"},
    {"--spacing-km", "KM"},
    {"--ring-spacing-km", "KM"},
    {"--height-km", "KM"},
    {"--hours", "HOURS"},
    {"--overlap-km", "KM"},
    {"--spacing-deg", "DEGREES"},
    {"--azimuth", "DEGREES"},
    {"--tilt", "DEGREES"},
    {"--orbit", "DEGREES"},
    {"--field-of-view", "DEGREES"},
    {"--echo-top-dbz", "DBZ"},
    {"--freezing-levels", "ZERO,MINUS20"},
    {"--minutes", "MINUTES"},
    {"--width", "PIXELS"},
    {"--height", "PIXELS"},
});

}  // namespace

std::span<const ValueWord> value_words() {
    return value_word_rows;
}

const ValueWord* find_value_word(std::string_view option, std::string_view command) {
    const ValueWord* of_all = nullptr;
    for (const ValueWord& row : value_words()) {
        if (row.option != option) continue;
        if (row.command == command) return &row;
        if (row.command.empty()) of_all = &row;
    }
    return of_all;
}

}  // namespace stormcellar::cli
