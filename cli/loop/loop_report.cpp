#include "cli/loop/loop_report.h"

#include <algorithm>

#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "cli/picture/picture.h"
#include "cli/shared/commands.h"
#include "stormcellar/base/version.h"
#include "stormcellar/cache/grid_file.h"
#include "stormcellar/render/product.h"

namespace stormcellar::cli {

void warn_skipped(const Skipped& skipped) {
    fmt::print(stderr, "stormcellar: warning: frame left out: {}\n", printable(skipped.reason));
}

namespace {

void add_archive(const ArchiveGrids& archive, nlohmann::json& document) {
    const pipeline::FillReport& report = archive.report;
    auto left_out = nlohmann::json::array();
    for (const pipeline::LeftOut& file : report.left_out)
        left_out.push_back({{"path", file.path.native()}, {"reason", file.reason}});
    document["cache"] = archive.directory.native();
    document["cache_bytes"] = archive.bytes;
    document["volumes"] = report.volumes;
    document["grids_made"] = report.grids_made;
    document["grids_found"] = report.grids_found;
    document["left_out"] = left_out;
    document["mosaics_made"] = report.frames_made;
    document["mosaics_found"] = report.frames_found;
    document["fill_s"] = archive.fill_s;
    document["mosaic_s"] = archive.frames_s;
}

}  // namespace

void print_report(const LoopOptions& options, const render::Scene& scene, const LoopReport& report,
                  const std::optional<ArchiveGrids>& archive) {
    if (!options.json) {
        if (options.quiet) return;
        std::vector<std::string> outputs = options.outputs;
        std::ranges::replace(outputs, options.piped, "standard output");
        fmt::print(stderr, "{}: {} {} to {}, {}, {} {} of {} x {} pixels, {:.1f} s\n",
                   printable(fmt::format("{}", fmt::join(outputs, ", "))),
                   printable(options.domain), format_utc(report.from), format_utc(report.to),
                   options.scene.product, report.frames,
                   plural(static_cast<std::uint64_t>(report.frames), "frame"), scene.width,
                   scene.height, report.total_s);
        return;
    }
    auto skipped = nlohmann::json::array();
    for (const Skipped& grid : report.skipped) {
        skipped.push_back({{"path", grid.path.native()}, {"reason", grid.reason}});
    }
    nlohmann::json document{{"outputs", options.outputs},
                            {"domain", options.domain},
                            {"product", options.scene.product},
                            {"moment", render::moment_asked(options.scene)},
                            {"from", format_utc(report.from)},
                            {"to", format_utc(report.to)},
                            {"frames", report.frames},
                            {"interpolated", report.interpolated},
                            {"between_s", report.between_s},
                            {"skipped", skipped},
                            {"width", scene.width},
                            {"height", scene.height},
                            {"read_s", report.read_s},
                            {"render_s", report.render_s},
                            {"encode_s", report.encode_s},
                            {"total_s", report.total_s}};
    if (archive) add_archive(*archive, document);
    (options.follow.wanted ? print_json_line : print_json)(document);
}

}  // namespace stormcellar::cli
