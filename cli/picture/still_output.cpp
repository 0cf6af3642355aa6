#include "cli/picture/still_output.h"

#include <fmt/format.h>

#include "base/name_list.h"
#include "cli/shared/output_file.h"
#include "stormcellar/render/product.h"

namespace stormcellar::cli {
namespace {

// Returns true for "-" (a PNG on standard output), and for "-" with an ending such as "-.webp".
bool is_piped(const std::string& output) {
    return is_stdout(output) || output.starts_with("-.");
}

}  // namespace

Status check_still_output(const std::string& output, render::Product product, bool json) {
    const std::string wanted =
        fmt::format("a frame is written as {}", render::known_still_formats());
    const bool names_format = is_stdout(output) || render::still_format_of(output) != nullptr;
    if (is_piped(output) && !names_format) {
        return fail(ErrorCode::bad_argument, "{}: {}", output, wanted);
    }
    if (Status fits = check_output_file(is_piped(output) ? "-" : output, render::still_endings(),
                                        wanted, json);
        !fits) {
        return fits;
    }
    if (still_format(output).encode_map == nullptr || render::is_map(product)) return {};
    return fail(ErrorCode::bad_argument,
                "{}: {} holds maps; {} is none: take --product composite or another map", output,
                still_format(output).name, render::product_name(product));
}

Status check_overlay_output(const std::string& output, const std::string& overlay) {
    if (overlay.empty() || still_format(output).encode_map == nullptr) return {};
    return fail(ErrorCode::bad_argument, "{}: {} holds data without marks; leave out --overlay",
                output, still_format(output).name);
}

const render::StillFormat& still_format(const std::string& output) {
    const render::StillFormat* format = render::still_format_of(output);
    return format != nullptr ? *format : render::still_formats().front();
}

Status write_still(const std::string& output, std::span<const std::byte> bytes) {
    return write_output(is_piped(output) ? "-" : output, bytes);
}

std::string still_help() {
    return fmt::format(
        "The picture to write, as {}, or - for a PNG on standard output (-.webp for another "
        "format). GeoTIFF, netCDF and KMZ hold a map without labels, for GIS, for programs and for "
        "globes",
        render::known_still_formats());
}

Result<render::TiffContent> parse_tiff_content(const std::string& name, const std::string& output) {
    if (name.empty()) return render::TiffContent::values;
    const auto content = render::tiff_content_from_name(name);
    if (!content) {
        return fail(ErrorCode::bad_argument, "--geotiff takes one of {}, not '{}'",
                    names_in(render::tiff_contents), name);
    }
    if (still_format(output).name != "GeoTIFF") {
        return fail(ErrorCode::bad_argument, "--geotiff needs an output that ends in .tif");
    }
    return *content;
}

}  // namespace stormcellar::cli
