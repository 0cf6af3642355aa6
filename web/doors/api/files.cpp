// Operations that return a grid as a file: CF netCDF, or the .scg file of the cache.
#include "stormcellar/export/grid_netcdf.h"
#include "web/doors/api/operations.h"
#include "web/doors/pictures/picture_answers.h"

namespace stormcellar::web {
namespace {

// Limit of the cells. While a netCDF file is made, the grid takes 5 bytes a cell in memory, and the
// file as much again.
constexpr std::size_t most_netcdf_cells = std::size_t{1} << 24;

std::string file_name_of(const OpenGrid& grid, std::string_view extension) {
    return cache::relative_path({grid.domain, grid.moment, grid.time})
        .filename()
        .replace_extension(extension)
        .string();
}

grid::Grid dense_grid(const OpenGrid& open) {
    const cache::GridDescription& description = open.file.description();
    grid::Grid grid = grid::to_dense(open.file.view());
    grid.moment = description.moment;
    grid.time = description.time;
    grid.start_time = description.start_time;
    grid.end_time = description.end_time;
    grid.sites = description.sites;
    grid.provenance = description.provenance;
    return grid;
}

Result<Kept> make_netcdf(const OpenGrid& open, int deflate) {
    const grid::Grid grid = dense_grid(open);
    if (Status whole = open.file.check_whole(); !whole) return pass_on(whole);
    const auto bytes = netcdf::grid_file_bytes({&grid, 1}, {deflate});
    if (!bytes) return pass_on(bytes);
    return Kept{text_of(std::string(reinterpret_cast<const char*>(bytes->data()), bytes->size())),
                fmt::format("\"{}-nc{}\"", open.id, deflate),
                {}};
}

std::string disposition(const std::string& name) {
    return fmt::format("attachment; filename=\"{}\"", name);
}

}  // namespace

Answer api_netcdf(const ApiCall& call) {
    const auto deflate = whole_parameter(call, "deflate", 0, 9, 1);
    if (!deflate) return json_error(deflate.error());
    const auto grid = find_grid(call);
    if (!grid) return grid.error();
    if ((*grid)->file.view().spec->cell_count() > most_netcdf_cells) {
        return json_error(400, fmt::format("a netCDF file is made of at most {} cells; take the "
                                           "grid's own file or Zarr",
                                           most_netcdf_cells));
    }
    const std::string key =
        fmt::format("netcdf/{}/{}/{}/{}/{}", (*grid)->domain, level2::moment_name((*grid)->moment),
                    format_utc((*grid)->time), (*grid)->id, *deflate);
    const auto kept =
        kept_or_made(call, key, [&] { return make_netcdf(**grid, static_cast<int>(*deflate)); });
    if (!kept) return kept.error();
    Entity entity;
    entity.bytes = {kept->bytes};
    entity.content_type = "application/x-netcdf";
    entity.etag = kept->etag;
    entity.max_age = max_age_of(call.path_value("time"), **grid);
    entity.headers = {{"Content-Disposition", disposition(file_name_of(**grid, ".nc"))}};
    return answer_with(call.request, std::move(entity));
}

Answer api_grid_file(const ApiCall& call) {
    const auto grid = find_grid(call);
    if (!grid) return grid.error();
    const cache::GridFile& file = (*grid)->file;
    if (Status whole = file.check_whole(); !whole) return json_error(whole.error());
    auto descriptor = file.duplicate_descriptor();
    if (!descriptor) return json_error(descriptor.error());
    Entity entity;
    entity.bytes = {
        FileSlice{std::make_shared<const Descriptor>(std::move(*descriptor)), 0, file.bytes()}};
    entity.content_type = "application/octet-stream";
    entity.etag = fmt::format("\"{}\"", (*grid)->id);
    entity.max_age = max_age_of(call.path_value("time"), **grid);
    entity.headers = {{"Content-Disposition", disposition(file_name_of(**grid, ".scg"))}};
    return answer_with(call.request, std::move(entity));
}

}  // namespace stormcellar::web
