// cli/picture/picture_grid.h -- the data of a picture: a grid of the cache, a grid made in memory
// from files, or one sweep of a file.
//
// Threads   One thread at a time may use a PictureGrid; several threads may use its view.
// Errors    See each function.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "cli/grid/grid_request.h"
#include "cli/grid/volume_source.h"
#include "cli/picture/swept_volume.h"
#include "render/options/scene_options.h"
#include "render/products/rain_total_grid.h"
#include "stormcellar/base/result.h"
#include "stormcellar/cache/grid_file.h"
#include "stormcellar/grid/brick_grid.h"
#include "stormcellar/grid/brick_view.h"
#include "stormcellar/render/scene.h"

namespace stormcellar::cli {

// Adds the options for a grid that is made for a picture. Does not add the options of the picture
// itself.
void add_picture_grid_options(CLI::App& app, GridOptions& options);
// Returns true if one of these options was typed. They make no sense for a grid of the cache.
[[nodiscard]] bool has_picture_grid_options(const GridOptions& options);

// Copies into the grid's options the scene's moment, how it is dealiased, and its storm motion.
void take_moment(const render::SceneOptions& scene, GridOptions& grid);

class PictureGrid {
  public:
    // Opens a grid of the cache. Errors: those of GridFile::open().
    [[nodiscard]] static Result<PictureGrid> open(const std::filesystem::path& file);
    // Decodes the files and makes the grid of their moment, as `stormcellar grid` does. The options
    // give the files, the moment, the place of the grid and the number of threads. Errors name the
    // file or the option.
    [[nodiscard]] static Result<PictureGrid> make(GridOptions options);
    // Decodes the files once and makes a grid of each moment of a list such as "REF,VEL". Returns
    // the grids in the order of the list. The first grid owns the volumes.
    [[nodiscard]] static Result<std::vector<PictureGrid>> make_each(GridOptions options);
    // Grids each file, and returns the largest values of each cell (RotationTrack). Errors: those
    // of make() and of RotationTrack::add().
    [[nodiscard]] static Result<PictureGrid> make_track(const GridOptions& options);
    // Returns a grid made of volumes, which it then owns.
    [[nodiscard]] static PictureGrid of_grid(grid::Grid grid, std::vector<SourceVolume> volumes,
                                             int threads);
    // Returns the total under a name. Errors: those of RainTotalGrid::bricks().
    [[nodiscard]] static Result<PictureGrid> of_rain(std::string name,
                                                     const render::RainTotalGrid& total);
    // Returns a grid that was made of others, under a name.
    [[nodiscard]] static PictureGrid of_bricks(std::string name, cache::GridDescription description,
                                               grid::BrickGrid bricks);
    // Takes the sweep of the volume that the scene names. Errors: those of place_sweep().
    [[nodiscard]] static Result<PictureGrid> of_sweep(SweptVolume volume,
                                                      const render::Scene& scene,
                                                      const grid::GridSpec* plane = nullptr);
    PictureGrid(PictureGrid&&) noexcept;
    PictureGrid& operator=(PictureGrid&&) noexcept;
    ~PictureGrid();

    // Returns false for an object that was moved from.
    [[nodiscard]] bool has_grid() const { return stored_ != nullptr || made_ != nullptr; }
    [[nodiscard]] grid::BrickView view() const;  // valid as long as this object lives
    [[nodiscard]] const cache::GridDescription& description() const;
    // Returns the name of the domain. For files, returns the station, or a mosaic's stations joined
    // by "+".
    [[nodiscard]] const std::string& name() const;
    // Returns the decoded volumes that the grid is from; empty for a grid of the cache.
    [[nodiscard]] const std::vector<SourceVolume>& volumes() const;
    // Checks that the grid's file in the cache was not truncated. Call it after using the view.
    [[nodiscard]] Status check_whole() const;

  private:
    // Grids each file; the earliest is the first.
    [[nodiscard]] static Result<std::vector<PictureGrid>> make_by_time(const GridOptions& options);
    struct Stored;
    struct Made;
    struct Swept;
    explicit PictureGrid(std::unique_ptr<Stored> stored);
    explicit PictureGrid(std::unique_ptr<Made> made);
    explicit PictureGrid(std::unique_ptr<Swept> swept);

    std::unique_ptr<Stored> stored_;  // one of stored_, made_ and swept_ is set
    std::unique_ptr<Made> made_;
    std::unique_ptr<Swept> swept_;
};

}  // namespace stormcellar::cli
