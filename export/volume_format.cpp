#include "stormcellar/export/volume_format.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/format_list.h"
#include "base/name_list.h"
#include "export/cfradial2.h"
#include "export/odim.h"
#include "export/uf.h"

namespace stormcellar::volume_export {
namespace {

constexpr std::array<std::string_view, 2> netcdf_endings{".nc", ".nc4"};
constexpr std::array<std::string_view, 3> hdf5_endings{".h5", ".hdf", ".hdf5"};
constexpr std::array<std::string_view, 1> uf_endings{".uf"};

constexpr std::array formats{
    VolumeFormat{"cfradial", "CfRadial", netcdf_endings, netcdf::write_volume},
    VolumeFormat{"cfradial2", "CfRadial 2", netcdf_endings, netcdf::write_cfradial2},
    VolumeFormat{"odim", "ODIM_H5", hdf5_endings, netcdf::write_odim},
    VolumeFormat{"uf", "UF", uf_endings, netcdf::write_uf},
};

}  // namespace

std::span<const VolumeFormat> volume_formats() {
    return formats;
}

const VolumeFormat* volume_format_named(std::string_view option) {
    const auto format = std::find_if(formats.begin(), formats.end(),
                                     [&](const VolumeFormat& one) { return one.option == option; });
    return format == formats.end() ? nullptr : &*format;
}

const VolumeFormat* volume_format_of(std::string_view file_name) {
    return find_format(volume_formats(), file_name);
}

std::vector<std::string_view> volume_endings() {
    std::vector<std::string_view> once;
    for (const std::string_view ending : endings_in(volume_formats())) {
        if (std::find(once.begin(), once.end(), ending) == once.end()) once.push_back(ending);
    }
    return once;
}

std::string known_volume_formats() {
    struct Named {
        std::string name;
    };
    std::vector<Named> known;
    for (const VolumeFormat& format : formats) {
        known.push_back({fmt::format("{} ({}, {})", format.option, format.name,
                                     fmt::join(format.endings, ", "))});
    }
    return names_in(known, ", ", " or ");
}

}  // namespace stormcellar::volume_export
