#include "export/grid_gltf.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <utility>

#include <nlohmann/json.hpp>

#include "export/grid_fields.h"
#include "export/surface_mesh.h"
#include "export/zarr_layout.h"
#include "stormcellar/base/utc_time.h"
#include "stormcellar/level2/moment.h"

namespace stormcellar::surfaces {
namespace {

using grid_export::GridFormatOptions;
using grid_export::GridSurface;
using Json = nlohmann::ordered_json;

static_assert(std::endian::native == std::endian::little, "glTF is little-endian");

// The numbers that glTF gives to kinds of arrays and of numbers.
constexpr int array_buffer = 34962, element_array_buffer = 34963;
constexpr int float_number = 5126, unsigned_int_number = 5125;

// The bytes and the arrays of a file while it is made.
class Asset {
  public:
    explicit Asset(const grid::Grid& grid) : grid_(grid) {
        json_ = {{"asset",
                  {{"version", "2.0"},
                   {"generator", "stormcellar " + grid.provenance.software_version}}},
                 {"scene", 0},
                 {"scenes", Json::array({{{"nodes", Json::array()}}})},
                 {"nodes", Json::array()},
                 {"meshes", Json::array()},
                 {"materials", Json::array()},
                 {"accessors", Json::array()},
                 {"bufferViews", Json::array()}};
    }

    void add_surface(const SurfaceMesh& mesh, const GridSurface& surface, double alpha) {
        const std::string name = fmt::format("{} {:g} {}", level2::moment_name(grid_.moment),
                                             surface.value, level2::moment_units(grid_.moment));
        const std::size_t number = json_["nodes"].size();
        const std::size_t positions = add_vectors(mesh.points);
        json_["accessors"][positions].update(bounds_of(mesh.points));
        const std::size_t normals = add_vectors(mesh.normals);
        const std::size_t indices = add_indices(mesh.corners);
        json_["scenes"][0]["nodes"].push_back(number);
        json_["nodes"].push_back(
            {{"name", name}, {"mesh", number}, {"extras", {{"value", surface.value}}}});
        json_["meshes"].push_back(
            {{"name", name},
             {"primitives",
              Json::array({{{"attributes", {{"POSITION", positions}, {"NORMAL", normals}}},
                            {"indices", indices},
                            {"material", number}}})}});
        json_["materials"].push_back(material(name, surface, alpha));
    }

    [[nodiscard]] bool is_empty() const { return json_["nodes"].empty(); }
    [[nodiscard]] std::size_t size() const { return data_.size(); }

    // Returns the file: a header, the chunk of JSON and the chunk of numbers.
    std::vector<std::byte> finish(Json extras) {
        constexpr std::size_t header_size = 12, chunk_header_size = 8;
        json_["scenes"][0]["extras"] = std::move(extras);
        json_["buffers"] = Json::array({{{"byteLength", data_.size()}}});
        std::string text = json_.dump(-1, ' ', false, Json::error_handler_t::replace);
        text.resize((text.size() + 3) / 4 * 4, ' ');
        std::string head;
        const auto add = [&head](std::size_t number) {
            const auto word = static_cast<std::uint32_t>(number);
            head.append(std::bit_cast<std::array<char, 4>>(word).data(), 4);
        };
        head += "glTF";
        add(2);
        add(header_size + 2 * chunk_header_size + text.size() + data_.size());
        add(text.size());
        head += "JSON" + text;
        add(data_.size());
        head += std::string_view("BIN\0", 4);
        std::vector<std::byte> file(head.size() + data_.size());
        std::memcpy(file.data(), head.data(), head.size());
        if (!data_.empty()) std::memcpy(file.data() + head.size(), data_.data(), data_.size());
        return file;
    }

  private:
    // Adds an array. All of its numbers have four bytes, so it stays aligned.
    std::size_t add_array(const void* first, std::size_t bytes, int target, Json accessor) {
        const std::size_t begin = data_.size();
        data_.resize(begin + bytes);
        if (bytes > 0) std::memcpy(data_.data() + begin, first, bytes);
        accessor["bufferView"] = json_["bufferViews"].size();
        json_["bufferViews"].push_back(
            {{"buffer", 0}, {"byteOffset", begin}, {"byteLength", bytes}, {"target", target}});
        json_["accessors"].push_back(std::move(accessor));
        return json_["accessors"].size() - 1;
    }

    std::size_t add_vectors(const std::vector<Vector>& vectors) {
        return add_array(
            vectors.data(), vectors.size() * sizeof(Vector), array_buffer,
            {{"componentType", float_number}, {"count", vectors.size()}, {"type", "VEC3"}});
    }

    std::size_t add_indices(const std::vector<std::uint32_t>& indices) {
        return add_array(indices.data(), indices.size() * sizeof(std::uint32_t),
                         element_array_buffer,
                         {{"componentType", unsigned_int_number},
                          {"count", indices.size()},
                          {"type", "SCALAR"}});
    }

    static Json bounds_of(const std::vector<Vector>& points) {
        Vector low = points.front(), high = points.front();
        for (const Vector& point : points) {
            for (std::size_t axis = 0; axis < 3; ++axis) {
                low[axis] = std::min(low[axis], point[axis]);
                high[axis] = std::max(high[axis], point[axis]);
            }
        }
        return {{"min", low}, {"max", high}};
    }

    // Colors of glTF are linear, those of tables are sRGB.
    static double linear(std::uint8_t code) {
        const double share = code / 255.0;
        return share <= 0.04045 ? share / 12.92 : std::pow((share + 0.055) / 1.055, 2.4);
    }

    static Json material(const std::string& name, const GridSurface& surface, double alpha) {
        const auto& [red, green, blue] = surface.color;
        Json made = {{"name", name},
                     {"pbrMetallicRoughness",
                      {{"baseColorFactor", {linear(red), linear(green), linear(blue), alpha}},
                       {"metallicFactor", 0},
                       {"roughnessFactor", 0.9}}},
                     {"doubleSided", true}};
        if (alpha < 1) made["alphaMode"] = "BLEND";
        return made;
    }

    const grid::Grid& grid_;
    Json json_;
    std::vector<std::byte> data_;
};

Json extras_of(std::span<const grid::Grid> grids, double height_scale) {
    const grid::Grid& grid = grids.front();
    const grid::GridSpec& spec = grid.spec;
    Json extras = {{"moment", level2::moment_name(grid.moment)},
                   {"units", level2::moment_units(grid.moment)},
                   {"time", format_utc(grid.frame_time.value_or(grid.time))},
                   {"origin_latitude_deg", spec.center_latitude_deg},
                   {"origin_longitude_deg", spec.center_longitude_deg},
                   {"height_scale", height_scale},
                   {"projection", netcdf::well_known_text(spec)}};
    extras.update(zarr::json_of(netcdf::provenance_attributes(grids)));
    extras.erase("Conventions");
    return extras;
}

Status check(std::span<const grid::Grid> grids, const GridFormatOptions& options) {
    if (Status good = netcdf::check_grids(grids); !good) return good;
    if (grids.size() > 1)
        return fail(ErrorCode::bad_argument, "glTF takes the surfaces of one moment, not of {}",
                    grids.size());
    if (options.surfaces.empty() || options.surfaces.size() > grid_export::most_surfaces) {
        return fail(ErrorCode::bad_argument, "glTF takes 1 to {} surfaces, not {}",
                    grid_export::most_surfaces, options.surfaces.size());
    }
    if (!(options.height_scale > 0) || !std::isfinite(options.height_scale))
        return fail(ErrorCode::bad_argument, "heights must be multiplied by more than 0, not {}",
                    options.height_scale);
    return {};
}

std::string values_in(std::span<const GridSurface> surfaces) {
    std::string text;
    for (const GridSurface& surface : surfaces)
        text += fmt::format("{}{:g}", text.empty() ? "" : ", ", surface.value);
    return text;
}

}  // namespace

Result<std::vector<std::byte>> gltf_bytes(std::span<const grid::Grid> grids,
                                          const GridFormatOptions& options) {
    if (Status good = check(grids, options); !good) return pass_on(good);
    const grid::Grid& grid = grids.front();
    Asset asset(grid);
    for (std::size_t at = 0; at < options.surfaces.size(); ++at) {
        const GridSurface& surface = options.surfaces[at];
        const SurfaceMesh mesh = surface_of(grid, surface.value, options.height_scale);
        const double alpha =
            static_cast<double>(at + 1) / static_cast<double>(options.surfaces.size());
        if (!mesh.corners.empty()) asset.add_surface(mesh, surface, alpha);
        constexpr std::size_t room_for_text = std::size_t{16} << 20;
        if (asset.size() > std::numeric_limits<std::uint32_t>::max() - room_for_text)
            return fail(ErrorCode::bad_argument,
                        "the surfaces need more than the 4 GB of a glTF file");
    }
    if (asset.is_empty()) {
        return fail(ErrorCode::bad_argument, "the grid of {} has no surface at {} {}",
                    level2::moment_name(grid.moment), values_in(options.surfaces),
                    level2::moment_units(grid.moment));
    }
    return asset.finish(extras_of(grids, options.height_scale));
}

Status write_gltf(FileSystem& file_system, const std::filesystem::path& path,
                  std::span<const grid::Grid> grids, const GridFormatOptions& options) {
    const auto bytes = gltf_bytes(grids, options);
    if (!bytes) return pass_on(bytes);
    return write_file_atomically(file_system, path, *bytes);
}

}  // namespace stormcellar::surfaces
