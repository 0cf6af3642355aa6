// Compares the viewer's picture of a volume with the slicer's picture of the same grid, with the
// same camera.
//   viewer_difference [--sun AZIMUTH,ELEVATION] GRID.scg PICTURE.ppm AZIMUTH TILT ZOOM
//     FIELD_OF_VIEW EXAGGERATION OPACITY LOOK_AT_X LOOK_AT_Y LOOK_AT_Z [--colors TABLE]
//     [--slices N] [SLICER.png]
// The picture shows the volume over black. If a sun is given, the volume is lit by its gradient.
// Distances are in meters. Prints the differences in CIEDE2000, and the number of pixels that are
// not black in both pictures; other pixels do not count. TABLE is a name or a file, as for
// `stormcellar frame --colors`; by default it is the moment's usual table. N is the number of
// slices. If SLICER.png is given, writes the slicer's picture there.
#include <array>
#include <cstdio>
#include <exception>
#include <fstream>
#include <optional>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "render/color/built_in_tables.h"
#include "render/color/color_difference.h"
#include "render/color/color_file.h"
#include "render/volume/slicer.h"
#include "stormcellar/cache/grid_file.h"
#include "stormcellar/render/png_file.h"
#include "stormcellar/render/view_geometry.h"

namespace stormcellar::render {
namespace {

constexpr int number_count = 9;
constexpr int first_number = 3;
constexpr int threads = 2;
constexpr Rgba8 black{0, 0, 0, 255};

bool is_black(const std::uint8_t* pixel) {
    return pixel[0] == 0 && pixel[1] == 0 && pixel[2] == 0;
}

// Both pictures, without the pixels that are black in both pictures. Each is one row.
struct Shown {
    Image one, other;
};
Shown shown_of(const Image& one, const Image& other) {
    Shown shown;
    for (std::size_t i = 0; i < one.rgba.size(); i += 4) {
        if (is_black(&one.rgba[i]) && is_black(&other.rgba[i])) continue;
        shown.one.rgba.insert(shown.one.rgba.end(), &one.rgba[i], &one.rgba[i] + 4);
        shown.other.rgba.insert(shown.other.rgba.end(), &other.rgba[i], &other.rgba[i] + 4);
    }
    shown.one.width = shown.other.width = static_cast<int>(shown.one.rgba.size() / 4);
    shown.one.height = shown.other.height = 1;
    return shown;
}

Image drawn(const grid::BrickView& view, const ColorTable& colors,
            const std::array<double, number_count>& numbers, const Light& light, int slices,
            int width, int height) {
    const auto [azimuth, tilt, zoom, field_of_view, exaggeration, opacity, x, y, z] = numbers;
    Camera camera;
    camera.azimuth_deg = azimuth;
    camera.tilt_deg = tilt;
    camera.zoom = zoom;
    camera.field_of_view_deg = field_of_view;
    camera.look_at = Eye{x, y, z};
    const ViewGeometry geometry(*view.spec, camera, exaggeration, width, height);
    const VolumeSlicer slicer(colors, view.quantization, geometry,
                              {.slices = slices, .opacity = opacity, .light = light}, nullptr,
                              threads);
    Image image(width, height, black);
    composite_over(slicer.draw(view, threads), image, 0, 0, threads);
    return image;
}

// Reads a picture as viewer_page.mjs writes it: "P6", width, height, 255, and three bytes a pixel.
std::optional<Image> read_ppm(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    std::string magic;
    int width = 0, height = 0, most = 0;
    file >> magic >> width >> height >> most;
    file.get();
    constexpr int largest_side = 8192;
    if (magic != "P6" || most != 255 || width < 1 || height < 1 || width > largest_side ||
        height > largest_side)
        return std::nullopt;
    Image image(width, height, black);
    for (std::size_t i = 0; i < image.rgba.size(); i += 4)
        file.read(reinterpret_cast<char*>(&image.rgba[i]), 3);
    if (!file) return std::nullopt;
    return image;
}

// Returns false if the file cannot be written.
bool write_png(const Image& image, const std::string& path) {
    const auto bytes = encode_png(image);
    if (!bytes) return false;
    std::ofstream file(path, std::ios::binary);
    file.write(reinterpret_cast<const char*>(bytes->data()),
               static_cast<std::streamsize>(bytes->size()));
    return static_cast<bool>(file);
}

int complain(std::string_view text) {
    fmt::print(stderr, "viewer_difference: {}\n", text);
    return 2;
}

// Takes "--sun AZIMUTH,ELEVATION" from the front of the arguments, if it is there.
Light light_of(int& argc, char**& argv) {
    Light light;
    if (argc < 3 || std::string_view(argv[1]) != "--sun") return light;
    const std::string sun = argv[2];
    light.gradient = true;
    light.sun_azimuth_deg = std::stod(sun);
    light.sun_elevation_deg = std::stod(sun.substr(sun.find(',') + 1));
    argc -= 2;
    argv += 2;
    return light;
}

int run(int argc, char** argv) {
    const Light light = light_of(argc, argv);
    if (argc < first_number + number_count) return complain("arguments are missing");
    const auto file = cache::GridFile::open(argv[1]);
    if (!file) return complain(file.error().message);
    const auto page = read_ppm(argv[2]);
    if (!page) return complain("the picture cannot be read");
    std::array<double, number_count> numbers{};
    for (int i = 0; i < number_count; ++i)
        numbers[static_cast<std::size_t>(i)] = std::stod(argv[first_number + i]);
    int last = first_number + number_count;
    Result<ColorTable> colors = smooth_color_table(file->description().moment);
    if (argc > last + 1 && std::string_view(argv[last]) == "--colors") {
        colors = colors_from(argv[last + 1]);
        last += 2;
    }
    if (!colors) return complain(colors.error().message);
    int slices = VolumeOptions{}.slices;
    if (argc > last + 1 && std::string_view(argv[last]) == "--slices") {
        slices = std::stoi(argv[last + 1]);
        last += 2;
    }
    const Image ours =
        drawn(file->view(), *colors, numbers, light, slices, page->width, page->height);
    if (argc > last && !write_png(ours, argv[last])) return complain("cannot write the picture");
    const Shown shown = shown_of(*page, ours);
    if (shown.one.width == 0) return complain("both pictures are black");
    const auto difference = image_difference(shown.one, shown.other);
    if (!difference) return complain(difference.error().message);
    fmt::print("{:.3f} {:.3f} {:.3f} {}\n", difference->percentile_99, difference->mean,
               difference->max, difference->pixels);
    return 0;
}

}  // namespace
}  // namespace stormcellar::render

int main(int argc, char** argv) {
    try {
        return stormcellar::render::run(argc, argv);
    } catch (const std::exception& error) {
        return stormcellar::render::complain(error.what());
    }
}
