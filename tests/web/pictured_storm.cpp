#include "tests/web/pictured_storm.h"

#include <cmath>
#include <optional>

#include <png.h>

#include "pipeline/ingest/ingest.h"
#include "stormcellar/base/file_system.h"
#include "stormcellar/cache/store.h"
#include "stormcellar/catalog/catalog.h"
#include "stormcellar/grid/projection.h"
#include "tests/testing/data.h"

namespace stormcellar::web {
namespace {

pipeline::IngestOptions options_of_storm(std::vector<level2::Moment> moments) {
    pipeline::IngestOptions options;
    options.moments = std::move(moments);
    options.spacing_m = 2000;
    options.nx = options.ny = 230;
    return options;
}

}  // namespace

render::Image decoded_png(const std::string& bytes) {
    png_image png{};
    png.version = PNG_IMAGE_VERSION;
    if (png_image_begin_read_from_memory(&png, bytes.data(), bytes.size()) == 0) return {};
    png.format = PNG_FORMAT_RGBA;
    render::Image image(static_cast<int>(png.width), static_cast<int>(png.height), {});
    png_image_finish_read(&png, nullptr, image.rgba.data(), 0, nullptr);
    return image;
}

PicturedStorm::PicturedStorm(const std::string& name, std::chrono::hours age,
                             std::vector<level2::Moment> moments) {
    std::filesystem::create_directory(directory_ / "drop");
    file_ = directory_ / "drop" / name;
    std::filesystem::copy_file(*testing::data_directory() / "volumes/KTLX19990503_235621.gz",
                               file_);
    std::filesystem::permissions(file_, std::filesystem::perms::owner_write,
                                 std::filesystem::perm_options::add);
    std::filesystem::last_write_time(file_, std::filesystem::file_time_type::clock::now() - age);
    auto catalog = catalog::CatalogWriter::open(directory_ / "catalog");
    auto store = cache::StoreWriter::open(real_file_system(), directory_ / "cache", true);
    EXPECT_TRUE(catalog && store);
    pipeline::Ingestor ingestor(*catalog, *store, options_of_storm(std::move(moments)));
    const auto outcome = ingestor.ingest(file_, true);
    EXPECT_TRUE(outcome) << outcome.error().message;
    auto grids = Grids::open({.cache = directory_ / "cache", .most_open = 8});
    EXPECT_TRUE(grids);
    grids_ = *grids;
}

std::shared_ptr<const OpenGrid> PicturedStorm::grid(level2::Moment moment) const {
    auto found = grids_->find("KTLX", moment, *grids_->newest("KTLX", moment));
    EXPECT_TRUE(found) << found.error().message;
    return *found;
}

void PictureTest::SetUp() {
    STORMCELLAR_NEED_DATA();
    static const auto storm = std::make_shared<const PicturedStorm>();
    storm_ = storm;
}

render::Rgba8 composite_color_at(const OpenGrid& grid, const render::Scene& scene,
                                 grid::GeoPoint place) {
    const grid::BrickView view = grid.file.view();
    const grid::ColumnPoint at = grid::GridProjection(*view.spec).to_column(place);
    const auto x = static_cast<int>(std::floor(at.x + 0.5));
    const auto y = static_cast<int>(std::floor(at.y + 0.5));
    if (x < 0 || y < 0 || x >= view.spec->nx || y >= view.spec->ny) return {0, 0, 0, 0};
    std::optional<float> largest;
    bool is_seen = false, is_folded = false, is_ambiguous = false;
    for (int z = 0; z < view.spec->nz(); ++z) {
        const grid::CellStatus status = view.status(x, y, z);
        is_seen = is_seen || status != grid::CellStatus::not_seen;
        is_folded = is_folded || status == grid::CellStatus::range_folded;
        is_ambiguous = is_ambiguous || status == grid::CellStatus::ambiguous;
        if (status != grid::CellStatus::value) continue;
        largest = std::max(largest.value_or(-1e9F), view.value(x, y, z));
    }
    const render::ColorTable& table = render::colors_of(scene);
    if (largest) return render::color_of(table, *largest).value_or(render::Rgba8{0, 0, 0, 0});
    if (is_ambiguous) {
        render::Rgba8 half_transparent = table.range_folded;
        half_transparent[3] /= 2;
        return half_transparent;
    }
    if (is_folded) return table.range_folded;
    return is_seen ? render::Rgba8{0, 0, 0, 0} : render::Rgba8{96, 100, 108, 72};
}

}  // namespace stormcellar::web
