#include "render/image/canvas.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <filesystem>

#include <cairo-ft.h>
#include <cairo.h>
#include <dlfcn.h>

namespace stormcellar::render {
namespace {

constexpr double farthest_text_px = 1e6;

constexpr std::array<const char*, 4> font_directories = {
    "/usr/share/fonts/truetype/dejavu", "/usr/share/fonts/dejavu-sans-fonts",
    "/usr/share/fonts/dejavu", "/usr/share/fonts/TTF"};

// Returns the directory "fonts" beside the program or library that has this code. The wheel of the
// Python package carries the font there, because a machine may have none.
std::filesystem::path carried_font_directory() {
    Dl_info own{};
    if (::dladdr(&font_directories, &own) == 0 || own.dli_fname == nullptr) return {};
    return std::filesystem::path(own.dli_fname).parent_path() / "fonts";
}

// The face of a font, with its bytes. Cairo frees both, because it may keep the face in its caches
// after we release it.
struct FreeTypeFace {
    FT_Library library = nullptr;
    FT_Face face = nullptr;

    FreeTypeFace() = default;
    FreeTypeFace(const FreeTypeFace&) = delete;
    FreeTypeFace& operator=(const FreeTypeFace&) = delete;
    ~FreeTypeFace() {
        if (face != nullptr) FT_Done_Face(face);
        if (library != nullptr) FT_Done_FreeType(library);
    }
};

void free_face(void* face) {
    delete static_cast<FreeTypeFace*>(face);
}

std::shared_ptr<cairo_font_face_t> load_face(const char* name) {
    static const cairo_user_data_key_t key{};
    auto font = std::make_unique<FreeTypeFace>();
    if (FT_Init_FreeType(&font->library) != 0) return nullptr;
    std::vector<std::filesystem::path> directories(font_directories.begin(),
                                                   font_directories.end());
    directories.push_back(carried_font_directory());
    for (const std::filesystem::path& directory : directories) {
        const std::string path = directory / name;
        if (FT_New_Face(font->library, path.c_str(), 0, &font->face) != 0) continue;
        cairo_font_face_t* face = cairo_ft_font_face_create_for_ft_face(font->face, 0);
        if (cairo_font_face_set_user_data(face, &key, font.get(), free_face) ==
            CAIRO_STATUS_SUCCESS) {
            static_cast<void>(font.release());  // the face owns it now
            return {face, cairo_font_face_destroy};
        }
        cairo_font_face_destroy(face);
        return nullptr;
    }
    return nullptr;
}

cairo_font_options_t* text_options() {
    cairo_font_options_t* options = cairo_font_options_create();
    cairo_font_options_set_antialias(options, CAIRO_ANTIALIAS_GRAY);
    cairo_font_options_set_hint_style(options, CAIRO_HINT_STYLE_SLIGHT);
    cairo_font_options_set_hint_metrics(options, CAIRO_HINT_METRICS_ON);
    return options;
}

void use_font(cairo_t* context, cairo_font_face_t* face, double size) {
    cairo_set_font_face(context, face);
    cairo_set_font_size(context, size);
    cairo_font_options_t* options = text_options();
    cairo_set_font_options(context, options);
    cairo_font_options_destroy(options);
}

void use_color(cairo_t* context, Rgba8 color) {
    cairo_set_source_rgba(context, color[0] / 255.0, color[1] / 255.0, color[2] / 255.0,
                          color[3] / 255.0);
}

// Converts Cairo's pixels (32-bit numbers 0xAARRGGBB) to the pixels of an image (bytes R G B A), or
// back, by swapping red and blue. The result is opaque. The compiler vectorizes this loop.
static_assert(std::endian::native == std::endian::little);
void swap_red_and_blue(const unsigned char* from, unsigned char* to, std::size_t pixels) {
    for (std::size_t i = 0; i < pixels; ++i) {
        std::uint32_t pixel = 0;
        std::memcpy(&pixel, from + 4 * i, sizeof pixel);
        pixel = 0xFF000000U | (pixel & 0xFF00U) | ((pixel & 0xFFU) << 16) | ((pixel >> 16) & 0xFFU);
        std::memcpy(to + 4 * i, &pixel, sizeof pixel);
    }
}

}  // namespace

Result<Fonts> Fonts::load() {
    Fonts fonts;
    fonts.regular_ = load_face("DejaVuSans.ttf");
    fonts.bold_ = load_face("DejaVuSans-Bold.ttf");
    if (fonts.regular_ == nullptr || fonts.bold_ == nullptr) {
        return fail(ErrorCode::not_found,
                    "labels need the font DejaVu Sans (package fonts-dejavu-core), which is not "
                    "in {}",
                    font_directories[0]);
    }
    return fonts;
}

double Fonts::width(std::string_view text, double size, bool bold) const {
    cairo_matrix_t scale;
    cairo_matrix_t identity;
    cairo_matrix_init_scale(&scale, size, size);
    cairo_matrix_init_identity(&identity);
    cairo_font_options_t* options = text_options();
    cairo_scaled_font_t* font = cairo_scaled_font_create(face(bold), &scale, &identity, options);
    cairo_text_extents_t extents{};
    cairo_scaled_font_text_extents(font, std::string(text).c_str(), &extents);
    cairo_scaled_font_destroy(font);
    cairo_font_options_destroy(options);
    return extents.x_advance;
}

void Canvas::Context::operator()(cairo_t* context) const {
    cairo_destroy(context);
}
void Canvas::Surface::operator()(cairo_surface_t* surface) const {
    cairo_surface_destroy(surface);
}

Canvas::Canvas(int width, int height, Rgba8 fill_color)
    : width_(width),
      height_(height),
      surface_(cairo_image_surface_create(CAIRO_FORMAT_RGB24, width, height)),
      context_(cairo_create(surface_.get())) {
    use_color(context_.get(), fill_color);
    cairo_paint(context_.get());
}

Canvas::Canvas(const Image& opaque)
    : width_(opaque.width),
      height_(opaque.height),
      surface_(cairo_image_surface_create(CAIRO_FORMAT_RGB24, opaque.width, opaque.height)),
      context_(cairo_create(surface_.get())) {
    place(opaque, 0, 0);
}

void Canvas::trace(const std::vector<Point>& points) const {
    cairo_new_path(context_.get());
    for (const Point& p : points)
        cairo_line_to(context_.get(), p.x, p.y);
}

void Canvas::fill(const Rect& rect, Rgba8 color) {
    use_color(context_.get(), color);
    cairo_rectangle(context_.get(), rect.x, rect.y, rect.width, rect.height);
    cairo_fill(context_.get());
}

void Canvas::fill(const std::vector<Point>& polygon, Rgba8 color) {
    trace(polygon);
    cairo_close_path(context_.get());
    use_color(context_.get(), color);
    cairo_fill(context_.get());
}

void Canvas::line(const std::vector<Point>& points, double line_width, Rgba8 color, bool closed) {
    trace(points);
    if (closed) cairo_close_path(context_.get());
    use_color(context_.get(), color);
    cairo_set_line_width(context_.get(), line_width);
    cairo_set_line_join(context_.get(), CAIRO_LINE_JOIN_ROUND);
    cairo_stroke(context_.get());
}

void Canvas::add_to_path(const std::vector<Point>& points, Point offset) {
    cairo_new_sub_path(context_.get());
    for (const Point& p : points)
        cairo_line_to(context_.get(), p.x + offset.x, p.y + offset.y);
}

void Canvas::draw_path(double line_width, Rgba8 color) {
    use_color(context_.get(), color);
    cairo_set_line_width(context_.get(), line_width);
    cairo_set_line_join(context_.get(), CAIRO_LINE_JOIN_BEVEL);
    // The fast setting takes half the time and looks the same.
    cairo_set_antialias(context_.get(), CAIRO_ANTIALIAS_FAST);
    cairo_stroke(context_.get());
    cairo_set_antialias(context_.get(), CAIRO_ANTIALIAS_DEFAULT);
}

void Canvas::clip(const std::vector<Point>& polygon) {
    unclip();
    trace(polygon);
    cairo_close_path(context_.get());
    cairo_clip(context_.get());
}

void Canvas::clip_both(const std::vector<Point>& one, const std::vector<Point>& other) {
    clip(one);
    trace(other);
    cairo_close_path(context_.get());
    cairo_clip(context_.get());
}

void Canvas::unclip() {
    cairo_reset_clip(context_.get());
}

void Canvas::text(const Fonts& fonts, std::string_view text, Point left_baseline, double size,
                  bool bold, Rgba8 color, Rgba8 halo) {
    cairo_t* context = context_.get();
    use_font(context, fonts.face(bold), size);
    const std::string terminated(text);
    const double x = std::nearbyint(left_baseline.x);
    const double y = std::nearbyint(left_baseline.y);
    const bool is_near = std::abs(x) < farthest_text_px && std::abs(y) < farthest_text_px;
    if (halo[3] > 0 && is_near) {
        CoverMask mask =
            halos_.halo_of(cairo_get_scaled_font(context), bold, size, terminated.c_str(),
                           static_cast<int>(x), static_cast<int>(y), std::max(2.0, size / 4));
        use_color(context, halo);
        paint_cover(context, mask);
    }
    cairo_move_to(context, x, y);
    use_color(context, color);
    cairo_show_text(context, terminated.c_str());
}

void Canvas::place(const Image& image, int left, int top) {
    cairo_surface_flush(surface_.get());
    unsigned char* pixels = cairo_image_surface_get_data(surface_.get());
    const int stride = cairo_image_surface_get_stride(surface_.get());
    const int first = std::max(0, -left);
    const int end = std::min(image.width, width_ - left);
    if (first >= end) return;
    for (int y = std::max(0, -top); y < std::min(image.height, height_ - top); ++y) {
        const auto from = static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                          static_cast<std::size_t>(first);
        swap_red_and_blue(image.rgba.data() + 4 * from,
                          pixels + static_cast<std::ptrdiff_t>(y + top) * stride +
                              std::ptrdiff_t{4} * (first + left),
                          static_cast<std::size_t>(end - first));
    }
    cairo_surface_mark_dirty(surface_.get());
}

Image Canvas::image() const {
    cairo_surface_flush(surface_.get());
    const unsigned char* pixels = cairo_image_surface_get_data(surface_.get());
    const int stride = cairo_image_surface_get_stride(surface_.get());
    Image image;  // the loop below sets every byte
    image.width = width_;
    image.height = height_;
    const auto width = static_cast<std::size_t>(width_);
    image.rgba.resize(4 * width * static_cast<std::size_t>(height_));
    for (int y = 0; y < height_; ++y) {
        swap_red_and_blue(pixels + static_cast<std::ptrdiff_t>(y) * stride,
                          image.rgba.data() + 4 * static_cast<std::size_t>(y) * width, width);
    }
    return image;
}

}  // namespace stormcellar::render
