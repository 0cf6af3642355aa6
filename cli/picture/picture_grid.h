// cli/picture/picture_grid.h -- what a picture is drawn from: a grid of the cache, one that was
// made in memory from files, or one sweep of a file.
//
// Threads   A PictureGrid may be used by one thread at a time, its view by any.
// Errors    See each function.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "cli/grid/grid_request.h"
#include "cli/grid/volume_source.h"
#include "cli/picture/swept_volume.h"
#include "stormcellar/base/result.h"
#include "stormcellar/cache/grid_file.h"
#include "stormcellar/grid/brick_view.h"
#include "stormcellar/render/scene.h"

namespace stormcellar::cli {

// The options of a grid that is made for a picture, beside those of the picture itself.
void add_picture_grid_options(CLI::App& app, GridOptions& options);
// True if one of them was typed, which makes no sense for a grid of the cache.
[[nodiscard]] bool has_picture_grid_options(const GridOptions& options);

class PictureGrid {
  public:
    // Errors: those of GridFile::open().
    [[nodiscard]] static Result<PictureGrid> open(const std::filesystem::path& file);
    // Decodes the files and grids their moment, as `stormcellar grid` does. The options say the
    // files, the moment, the place of the grid and the number of threads. Errors name the file or
    // the option.
    [[nodiscard]] static Result<PictureGrid> make(GridOptions options);
    // The same for several moments, "REF,VEL", of one decoding: a grid each, in the order of their
    // names. The volumes belong to the first.
    [[nodiscard]] static Result<std::vector<PictureGrid>> make_each(GridOptions options);
    // Takes the sweep of the volume that the scene names. Errors: those of place_sweep().
    [[nodiscard]] static Result<PictureGrid> of_sweep(SweptVolume volume,
                                                      const render::Scene& scene,
                                                      const grid::GridSpec* plane = nullptr);
    PictureGrid(PictureGrid&&) noexcept;
    PictureGrid& operator=(PictureGrid&&) noexcept;
    ~PictureGrid();

    // False once it was moved from.
    [[nodiscard]] bool has_grid() const { return stored_ != nullptr || made_ != nullptr; }
    [[nodiscard]] grid::BrickView view() const;  // valid as long as this object lives
    [[nodiscard]] const cache::GridDescription& description() const;
    // Returns the domain; for files, the station, or a mosaic's stations with "+" between them.
    [[nodiscard]] const std::string& name() const;
    // The decoded volumes that it was made from; empty for a grid of the cache.
    [[nodiscard]] const std::vector<SourceVolume>& volumes() const;
    // Call after the view was used, because a file of the cache may have been truncated meanwhile.
    [[nodiscard]] Status check_whole() const;

  private:
    struct Stored;
    struct Made;
    struct Swept;
    explicit PictureGrid(std::unique_ptr<Stored> stored);
    explicit PictureGrid(std::unique_ptr<Made> made);
    explicit PictureGrid(std::unique_ptr<Swept> swept);

    std::unique_ptr<Stored> stored_;  // one of the three
    std::unique_ptr<Made> made_;
    std::unique_ptr<Swept> swept_;
};

}  // namespace stormcellar::cli
