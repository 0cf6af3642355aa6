#include "render/options/scene_options.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <thread>
#include <utility>
#include <variant>

#include "base/floating_point.h"
#include "base/local_time.h"
#include "base/split.h"
#include "render/color/built_in_tables.h"
#include "render/color/color_file.h"
#include "render/options/moment_name.h"
#include "render/overlay/shape_file.h"
#include "retrieve/nowcast/nowcast_note.h"
#include "retrieve/rain/rain_note.h"

namespace stormcellar::render {

namespace {

std::string spelled(const PictureOption& row, const SceneOptions& options) {
    return std::string(options.spelling == Spelling::option ? row.option : parameter_of(row));
}

Status unused(std::string_view name, const PictureOption& row, Product product) {
    std::string uses = row.used_by.text();
    if (row.used_by_moment)
        uses += fmt::format(", for the moment {}", level2::moment_name(*row.used_by_moment));
    if (row.used_by_cells) uses += " and beside an overlay of cells";
    return fail(ErrorCode::bad_argument, "{} is for {}; {} does not use it", name, uses,
                product_name(product));
}

// Returns true if the moment or one of the panels is this one.
bool shows(level2::Moment wanted, const SceneOptions& options) {
    const std::string asked = options.panels.empty() ? moment_asked(options) : options.panels;
    const auto names = split(asked, ',');
    return std::ranges::any_of(names, [wanted](std::string_view name) {
        const auto moment = moment_named(std::string(name));
        return moment && *moment == wanted;
    });
}

bool is_used(const PictureOption& row, Product product, const SceneOptions& options) {
    return row.is_used_by(product) || (row.used_by_cells && marks_cells(options)) ||
           (row.used_by_moment && shows(*row.used_by_moment, options));
}

// Checks that the product uses all options that are given. Errors: bad_argument; the message names
// the option or the key, and the products that use it.
Status check_uses(Product product, const SceneOptions& options) {
    const auto files = product_from_name(options.file_product);
    for (const PictureOption& row : picture_options()) {
        if (is_used(row, product, options)) continue;
        if (contains(options.typed, row)) return unused(spelled(row, options), row, product);
        const bool was_used = files && row.is_used_by(*files);
        if (!was_used && contains(options.in_file, row)) return unused(key_of(row), row, product);
    }
    return {};
}

// A row whose number is out of range.
struct OutOfRange {
    PictureSettings to;
    std::optional<std::string> operator()(const WholeValue& value) const {
        return said(value.range, *value.field(to), false);
    }
    std::optional<std::string> operator()(const NumberValue& value) const {
        NumberRange range = value.range;
        const double* const field = value.field(to);
        // Only a camera that has a place may look up.
        const bool looks_down = field == &to.scene.camera.tilt_deg && !to.scene.camera.eye;
        if (looks_down) range = limits::tilt_deg;
        return said(range, *field / value.unit, value.or_zero);
    }
    template <class Other>
    std::optional<std::string> operator()(const Other& /*value*/) const {
        return std::nullopt;
    }
    static std::optional<std::string> said(NumberRange range, double number, bool or_zero) {
        if (is_within(number, range.least, range.most)) return std::nullopt;
        if (or_zero && std::fpclassify(number) == FP_ZERO) return std::nullopt;
        return fmt::format("must be {} to {}{}, not {}", range.least, range.most,
                           or_zero ? ", or 0" : "", number);
    }
};

// Checks that numbers are in their ranges. Errors: bad_argument; the message names the option, or
// the key if a scene file has the number.
Status check_ranges(SceneOptions options) {
    const PictureSettings to{options, options.scene, nullptr};
    for (const PictureOption& row : picture_options()) {
        // An option that was not given may have a value out of range, which means the default.
        const bool is_given = contains(options.typed, row) || contains(options.in_file, row);
        if (row.is_of_loop() || !is_given) continue;
        const auto said = std::visit(OutOfRange{to}, row.value);
        if (!said) continue;
        const bool is_in_file = !contains(options.typed, row) && contains(options.in_file, row);
        return fail(ErrorCode::bad_argument, "{} {}",
                    is_in_file ? key_of(row) : spelled(row, options), *said);
    }
    return {};
}

// Returns the moment to draw. For VEL this is VELD if the options ask for dealiasing.
Result<level2::Moment> dealiased_moment(level2::Moment moment, const SceneOptions& options) {
    const auto rung = retrieve::dealiasing_from_name(options.dealias);
    if (!rung) return fail(ErrorCode::bad_argument, "{}", rung.error().message);
    const bool is_velocity = level2::measured_moment(moment) == level2::Moment::vel;
    const bool is_derived = level2::is_dealiased(moment);
    if (*rung == retrieve::Dealiasing::off) {
        const bool is_given = contains(options.typed, dealias_option()) ||
                              contains(options.in_file, dealias_option());
        if (!is_given || !is_derived) return moment;
        return fail(ErrorCode::bad_argument, "{} off does not go with {} {}, which is dealiased",
                    spelled(dealias_option(), options), spelled(moment_option(), options),
                    level2::moment_name(moment));
    }
    if (!is_velocity && !options.panels.empty()) return moment;
    if (is_velocity) return is_derived ? moment : level2::Moment::veld;
    return fail(ErrorCode::bad_argument, "{} is for velocity; the moment is {}",
                spelled(dealias_option(), options), level2::moment_name(moment));
}

// Refuses a storm motion if the moment does not need one. Panels have several moments, so they are
// not refused.
Status check_storm_motion(level2::Moment moment, const SceneOptions& options) {
    const auto motion = retrieve::motion_choice_from(options.storm_motion);
    if (!motion) return fail(ErrorCode::bad_argument, "{}", motion.error().message);
    const bool is_used = moment == level2::Moment::srv || !options.panels.empty();
    if (is_used || options.storm_motion == retrieve::automatic_motion) return {};
    return fail(ErrorCode::bad_argument,
                "{} is for the storm-relative velocity, SRV; the moment is {}",
                spelled(storm_motion_option(), options), level2::moment_name(moment));
}

constexpr std::string_view track_words = "largest values since ";

std::optional<UtcTime> track_start(const std::vector<std::string>& notes) {
    for (const std::string& note : notes) {
        if (!note.starts_with(track_words)) continue;
        const auto time = parse_utc(note.substr(track_words.size()), UtcTime{});
        if (time) return *time;
    }
    return std::nullopt;
}

}  // namespace

Result<Scene> scene_of(const SceneOptions& options) {
    if (options.problem) return tl::unexpected(*options.problem);
    const auto product = product_from_name(options.product);
    if (!product) return pass_on(product);
    if (auto used = check_uses(*product, options); !used) return pass_on(used);
    if (auto ranges = check_ranges(options); !ranges) return pass_on(ranges);
    Scene scene = options.scene;
    scene.product = *product;
    const auto moment = moment_named(moment_asked(options));
    if (!moment) return fail(ErrorCode::bad_argument, "the moment {}", moment.error().message);
    const auto shown = dealiased_moment(*moment, options);
    if (!shown) return pass_on(shown);
    scene.moment = *shown;
    if (auto used = check_storm_motion(*shown, options); !used) return pass_on(used);
    const auto theme = theme_from_name(options.theme);
    if (!theme) return pass_on(theme);
    scene.theme = *theme;
    if (scene.product == Product::section && !scene.section) {
        return fail(ErrorCode::bad_argument,
                    "a section needs its two ends; give {} LAT,LON,LAT,LON or two names of places, "
                    "or {} in a scene file",
                    spelled(section_option(), options), key_of(section_option()));
    }
    if (scene.elevation_deg != Scene::lowest_sweep && scene.sweep_number != Scene::no_number) {
        return fail(ErrorCode::bad_argument,
                    "a sweep is named by its elevation or by its number; give only one of them");
    }
    // If nothing chooses colors, a picture has the table without classes. But a scene file keeps
    // the defaults of the time when it was written.
    const bool has_own_colors = facts_of(scene.product).colors != nullptr;
    if (options.colors.empty() && options.file_product.empty() && !has_own_colors) {
        scene.colors = smooth_color_table(scene.moment);
    } else if (const auto* table = table_of_family(options.colors, scene.moment)) {
        scene.colors = *table;
    } else if (!options.colors.empty()) {
        auto colors = colors_from(options.colors);
        if (!colors) return pass_on(colors);
        scene.colors = std::move(*colors);
    }
    scene.smooth =
        options.smooth.empty() ? options.file_product.empty() : options.smooth == "cubic";
    // A camera that has a place looks in perspective.
    if (scene.camera.eye && scene.camera.field_of_view_deg == 0) {
        scene.camera.field_of_view_deg = 60;
    }
    scene.labels = !options.no_labels;
    if (auto valid = validate(scene); !valid) return pass_on(valid);
    return scene;
}

bool chooses_levels(const SceneOptions& options) {
    return contains(options.typed, freezing_levels_option()) ||
           contains(options.in_file, freezing_levels_option());
}

std::optional<retrieve::FreezingLevels> chosen_freezing_levels(const SceneOptions& options,
                                                               const Scene& scene) {
    if (!chooses_levels(options) && facts_of(scene.product).hail == nullptr) return std::nullopt;
    return scene.freezing_levels;
}

bool marks_cells(const SceneOptions& options) {
    const auto words = split(options.overlay, ',');
    return std::ranges::find(words, overlay_cells) != words.end();
}

std::string shape_names(const SceneOptions& options) {
    std::string names;
    for (const std::string_view word : split(options.overlay, ',')) {
        if (word.empty() || word == overlay_cells) continue;
        if (!names.empty()) names += ", ";
        names += std::filesystem::path(word).filename().string();
    }
    return names;
}

Result<std::optional<ShapeOverlay>> read_shapes(const SceneOptions& options) {
    std::optional<ShapeOverlay> all;
    for (const std::string_view word : split(options.overlay, ',')) {
        if (word.empty() || word == overlay_cells) continue;
        auto shapes = read_shape_file(word);
        if (!shapes) return pass_on(shapes);
        if (!all) {
            all = std::move(*shapes);
            all->name = shape_names(options);
            continue;
        }
        all->unknown += shapes->unknown;
        std::ranges::move(shapes->shapes, std::back_inserter(all->shapes));
    }
    return all;
}

std::string moment_asked(const SceneOptions& options) {
    const auto product = product_from_name(options.product);
    const auto only = product ? facts_of(*product).only_moment : std::nullopt;
    const bool is_given = contains(options.typed, moment_option()) ||
                          contains(options.in_file, moment_option()) || !options.panels.empty();
    return only && !is_given ? std::string(level2::moment_name(*only)) : options.moment;
}

Status check_stored_derivation(const SceneOptions& options, Product product) {
    if (facts_of(product).is_of_sweep) return {};
    const auto rung = retrieve::dealiasing_from_name(options.dealias);
    const bool is_chosen =
        rung && *rung != retrieve::Dealiasing::off && *rung != retrieve::Dealiasing::automatic;
    if (is_chosen) {
        return fail(ErrorCode::bad_argument,
                    "{} {} is for frames of files and for a ppi; kept grids are dealiased already, "
                    "and auto draws them",
                    spelled(dealias_option(), options), options.dealias);
    }
    if (options.quality > 0) {
        return fail(ErrorCode::bad_argument,
                    "{} is for frames of files and for a ppi; kept grids have all echo, or what "
                    "the service left of it",
                    spelled(quality_option(), options));
    }
    const bool has_levels = chooses_levels(options) && shows(level2::Moment::hca, options) &&
                            facts_of(product).hail == nullptr && !marks_cells(options);
    if (has_levels) {
        return fail(ErrorCode::bad_argument,
                    "{} of HCA is for frames of files and for a ppi; the classes of kept grids are "
                    "made already",
                    spelled(freezing_levels_option(), options));
    }
    if (options.storm_motion == retrieve::automatic_motion) return {};
    return fail(ErrorCode::bad_argument,
                "{} is for frames of files and for a ppi; kept grids have the motion of their own "
                "wind profile",
                spelled(storm_motion_option(), options));
}

Status check_single_grid(Product product) {
    if (!facts_of(product).is_over_time) return {};
    return fail(ErrorCode::bad_argument, "{} {} made from several volumes: give several files{}",
                product_name(product), facts_of(product).is_sum ? "is" : "are",
                facts_of(product).is_sum ? "" : ", or draw a loop");
}

std::string track_note(UtcTime since) {
    return fmt::format("{}{}", track_words, format_utc(since));
}

retrieve::DerivedOptions derived_options_of(const SceneOptions& options) {
    retrieve::DerivedOptions derived;
    const auto rung = retrieve::dealiasing_from_name(options.dealias);
    if (rung && *rung != retrieve::Dealiasing::off) derived.dealiasing = *rung;
    derived.motion = retrieve::motion_choice_from(options.storm_motion).value_or(derived.motion);
    derived.quality = options.quality;
    derived.zero_c_m = options.scene.freezing_levels.zero_c_m;
    return derived;
}

int thread_count(const SceneOptions& options) {
    if (options.threads > 0) return options.threads;
    return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

FrameFacts frame_facts_of(const std::string& domain, const cache::GridDescription& description,
                          const std::string& time_zone, UtcTime now) {
    FrameFacts facts{domain, description.moment, description.time, description.sites,
                     description.provenance.partial};
    facts.radar_troubles = description.provenance.radar_troubles;
    facts.left_out = description.provenance.left_out;
    if (description.moment == level2::Moment::srv)
        facts.storm_motion = retrieve::motion_in_notes(description.provenance.notes);
    facts.quality = retrieve::quality_in_notes(description.provenance.notes);
    facts.since = track_start(description.provenance.notes);
    if (auto rain = retrieve::rain_in_notes(description.provenance.notes)) {
        facts.since = rain->from;
        facts.rain = std::move(rain->span);
    }
    auto note = retrieve::nowcast_in_notes(description.provenance.notes);
    facts.nowcast = std::move(note.nowcast);
    facts.nowcast_score = std::move(note.score);
    // Grids of other moments of the volume have the note, too.
    if (level2::is_dealiased(description.moment))
        facts.dealiasing = retrieve::dealiasing_in_notes(description.provenance.notes);
    const std::string zone = time_zone.empty() ? machine_time_zone() : time_zone;
    const auto local = zone.empty() ? std::string{} : format_local(facts.time, zone).value_or("");
    if (!local.ends_with(" UTC")) facts.local_time = local;
    const auto age = std::chrono::floor<std::chrono::seconds>(now - description.end_time);
    if (age >= std::chrono::seconds(0) && age < std::chrono::hours(1)) {
        facts.antenna_to_picture = age;
    }
    return facts;
}

}  // namespace stormcellar::render
