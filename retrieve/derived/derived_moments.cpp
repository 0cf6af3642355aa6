#include "stormcellar/retrieve/derived_moments.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <iterator>
#include <limits>
#include <utility>

#include "base/printable.h"
#include "retrieve/derived/hydrometeor_moment.h"
#include "retrieve/derived/quality_moment.h"
#include "retrieve/derived/rain_moments.h"
#include "retrieve/derived/read_folds.h"
#include "retrieve/derived/shear_moments.h"

namespace stormcellar::retrieve {
namespace {

using level2::Moment;
using level2::SweepMoment;

constexpr std::uint16_t code_of_ambiguous = 2;
constexpr double most_relative_mps = 320;

struct RuleFacts {
    MotionRule rule = MotionRule::right;
    std::string_view word = {};    // in options
    std::string_view source = {};  // in notes
};
constexpr std::array<RuleFacts, 3> profile_rules = {
    {{MotionRule::right, "right", "right mover of the wind profile"},
     {MotionRule::left, "left", "left mover of the wind profile"},
     {MotionRule::mean, "mean", "mean wind from 0 to 6 km"}}};
constexpr std::string_view given_source = "as given";

struct ChosenMotion {
    Motion motion;
    std::string_view source;
};

// Rounds a motion to its text.
Motion rounded(const Motion& motion) {
    return parse_motion(format_motion(motion)).value_or(motion);
}

Result<ChosenMotion> chosen_motion(const level2::Volume& volume, const MotionChoice& choice) {
    if (choice.rule == MotionRule::given) return ChosenMotion{rounded(choice.motion), given_source};
    const auto layers = wind_profile(volume, read_folds(volume));
    if (!layers) return pass_on(layers);
    const auto motions = bunkers_motions(*layers);
    if (!motions)
        return fail(motions.error().code, "the wind profile gives no storm motion: {}",
                    motions.error().message);
    const Motion& motion = choice.rule == MotionRule::right  ? motions->right
                           : choice.rule == MotionRule::left ? motions->left
                                                             : motions->mean;
    const auto* facts = std::ranges::find(profile_rules, choice.rule, &RuleFacts::rule);
    return ChosenMotion{rounded(motion), facts->source};
}

std::uint16_t storm_relative_code(const SweepMoment& dealiased, std::uint16_t code,
                                  double storm_mps) {
    if (code < level2::facts_of(dealiased.moment).first_valid_code) return code;
    const double velocity = static_cast<double>(dealiased.value_of(code)) - storm_mps;
    const bool is_in_range = std::abs(velocity) <= most_relative_mps;
    if (!is_in_range) return code_of_ambiguous;
    return static_cast<std::uint16_t>(std::lrint(velocity * static_cast<double>(dealiased.scale) +
                                                 static_cast<double>(dealiased.offset)));
}

// Returns the component of the motion along a radial, which is the same for all gates of the
// radial. For damaged angles, returns infinity, which makes the gates ambiguous.
double along_radial_mps(const level2::Radial& radial, const Motion& storm) {
    if (!std::isfinite(radial.azimuth_deg) || !std::isfinite(radial.elevation_deg))
        return std::numeric_limits<double>::infinity();
    return -storm_relative_mps(0, radial.azimuth_deg, radial.elevation_deg, storm);
}

SweepMoment storm_relative_moment(const level2::Sweep& sweep, const SweepMoment& dealiased,
                                  const Motion& storm) {
    SweepMoment made = dealiased;
    made.moment = Moment::srv;
    for (std::size_t radial = 0; radial < sweep.radials.size(); ++radial) {
        const double storm_mps = along_radial_mps(sweep.radials[radial], storm);
        const std::size_t row = radial * static_cast<std::size_t>(dealiased.gate_stride);
        for (std::int32_t gate = 0; gate < dealiased.gate_counts[radial]; ++gate) {
            made.codes16[row + static_cast<std::size_t>(gate)] =
                storm_relative_code(dealiased, dealiased.code(radial, gate), storm_mps);
        }
    }
    return made;
}

// Notes of mosaics begin with the station, as in "KTLX: storm motion 240/15, as given".
constexpr std::string_view motion_words = "storm motion ";

// Adds SRV and returns the notes.
Result<std::vector<std::string>> add_storm_relative(level2::Volume& volume,
                                                    const MotionChoice& choice) {
    const auto storm = chosen_motion(volume, choice);
    if (!storm) return pass_on(storm);
    for (level2::Sweep& sweep : volume.sweeps) {
        std::vector<SweepMoment> made;
        for (const SweepMoment& kind : sweep.moments)
            if (kind.moment == Moment::veld)
                made.push_back(storm_relative_moment(sweep, kind, storm->motion));
        std::ranges::move(made, std::back_inserter(sweep.moments));
    }
    return std::vector{
        fmt::format("{}{}, {}", motion_words, format_motion(storm->motion), storm->source)};
}

// Returns a copy of the sweep that has no moments but VEL.
level2::Sweep velocities_of(const level2::Sweep& sweep) {
    level2::Sweep copy{sweep.elevation_number,  sweep.message_type, sweep.azimuth_spacing_deg,
                       sweep.vcp_elevation_deg, sweep.radials,      {}};
    std::ranges::copy_if(sweep.moments, std::back_inserter(copy.moments),
                         [](const SweepMoment& kind) { return kind.moment == Moment::vel; });
    return copy;
}

// Returns true if each sweep has the wanted moment as often as it has VELD.
bool has_with_dealiased(const level2::Volume& volume, Moment wanted) {
    return std::ranges::all_of(volume.sweeps, [wanted](const level2::Sweep& sweep) {
        return std::ranges::count(sweep.moments, Moment::veld, &SweepMoment::moment) ==
               std::ranges::count(sweep.moments, wanted, &SweepMoment::moment);
    });
}

constexpr std::string_view shear_words = "shear of velocities dealiased by the rung ";

// Returns the text after these words, up to a character, if all notes that have these words agree.
std::optional<std::string> text_in_notes(std::span<const std::string> notes, std::string_view words,
                                         char end = ',') {
    std::optional<std::string> text;
    for (const std::string& note : notes) {
        const std::size_t at = note.find(words);
        const bool is_at_start = at == 0 || (at != note.npos && note.substr(0, at).ends_with(": "));
        if (!is_at_start) continue;
        const std::size_t from = at + words.size();
        std::string found = note.substr(from, note.find(end, from) - from);
        if (text && *text != found) return std::nullopt;
        text = std::move(found);
    }
    return text;
}

}  // namespace

Result<MotionChoice> motion_choice_from(std::string_view text) {
    if (text == automatic_motion) return MotionChoice{};
    for (const RuleFacts& facts : profile_rules)
        if (facts.word == text) return MotionChoice{facts.rule};
    const auto motion = parse_motion(text);
    if (motion) return MotionChoice{MotionRule::given, *motion};
    return fail(ErrorCode::bad_argument, "'{}' is no storm motion; it must be {}", printable(text),
                motion_choices());
}

std::string motion_choices() {
    return "auto, right, left, mean, or a motion such as 240/15, from 240 degrees at 15 m/s";
}

std::string motion_choice_text(const MotionChoice& choice) {
    if (choice.rule == MotionRule::given) return format_motion(choice.motion);
    return std::string(std::ranges::find(profile_rules, choice.rule, &RuleFacts::rule)->word);
}

bool is_of_motion(std::span<const std::string> notes, const MotionChoice& choice) {
    const auto* facts = std::ranges::find(profile_rules, choice.rule, &RuleFacts::rule);
    return std::ranges::all_of(notes, [&](const std::string& note) {
        const std::size_t at = note.find(motion_words);
        const bool is_motion = at == 0 || (at != note.npos && note.substr(0, at).ends_with(": "));
        if (!is_motion) return true;
        if (choice.rule != MotionRule::given) return note.ends_with(facts->source);
        return note.substr(at + motion_words.size()) ==
               fmt::format("{}, {}", format_motion(choice.motion), given_source);
    });
}

Result<Derived> add_derived_moments(level2::Volume& volume, std::span<const Moment> wanted,
                                    const DerivedOptions& options) {
    Derived derived;
    if (options.quality > 0)
        derived.notes.push_back(
            weather_note(options.quality, keep_weather(volume, options.quality)));
    for (level2::Sweep& sweep : volume.sweeps)
        std::erase_if(sweep.moments, [](const SweepMoment& kind) {
            return level2::facts_of(kind.moment).is_derived;
        });
    if (std::ranges::find(wanted, Moment::pow) != wanted.end()) add_quality_moment(volume);
    add_rain_moments(volume, wanted);
    if (std::ranges::find(wanted, Moment::hca) != wanted.end())
        derived.notes.push_back(add_hydrometeor_moment(volume, options.zero_c_m));
    if (std::ranges::none_of(wanted, level2::is_dealiased)) return derived;
    if (options.dealiasing == Dealiasing::off)
        return fail(ErrorCode::bad_argument, "moments derived from velocities need dealiasing");
    auto dealiased = add_dealiased_velocity(volume, options.dealiasing);
    if (!dealiased) return pass_on(dealiased);
    derived.dealiased = std::move(*dealiased);
    const auto shear = add_shear_moments(volume, derived.dealiased, wanted);
    if (!shear) return pass_on(shear);
    if (*shear)
        derived.notes.push_back(
            fmt::format("{}{}", shear_words, dealiasing_name(derived.dealiased.rung)));
    if (std::ranges::find(wanted, Moment::srv) == wanted.end()) return derived;
    auto notes = add_storm_relative(volume, options.motion);
    if (!notes) return pass_on(notes);
    std::ranges::move(*notes, std::back_inserter(derived.notes));
    return derived;
}

bool must_derive(std::span<const Moment> wanted, const DerivedOptions& options) {
    return options.quality > 0 || std::ranges::any_of(wanted, [](Moment moment) {
               return level2::facts_of(moment).is_derived;
           });
}

Result<std::vector<std::string>> add_from_dealiased(level2::Volume& volume, Moment wanted,
                                                    const DerivedOptions& options) {
    if (wanted == Moment::veld) return std::vector<std::string>{};
    const std::vector shear_note = {
        fmt::format("{}{}", shear_words, dealiasing_name(options.dealiasing))};
    if (wanted != Moment::srv && has_with_dealiased(volume, wanted)) return shear_note;
    for (level2::Sweep& sweep : volume.sweeps)
        std::erase_if(sweep.moments,
                      [&](const SweepMoment& kind) { return kind.moment == wanted; });
    if (wanted == Moment::srv) return add_storm_relative(volume, options.motion);
    const auto shear = add_shear_moments(volume, read_folds(volume), std::array{wanted});
    if (!shear) return pass_on(shear);
    return shear_note;
}

Result<DerivedVolume> derived_velocities(const level2::Volume& volume,
                                         std::span<const Moment> wanted,
                                         const DerivedOptions& options) {
    level2::Volume made{volume.header,
                        volume.station,
                        volume.block,
                        volume.vcp_message,
                        volume.vcp,
                        volume.vcp_source,
                        {}};
    const bool needs_all =
        options.quality > 0 || std::ranges::any_of(wanted, level2::uses_all_moments);
    for (const level2::Sweep& sweep : volume.sweeps)
        made.sweeps.push_back(needs_all ? sweep : velocities_of(sweep));
    auto derived = add_derived_moments(made, wanted, options);
    if (!derived) return pass_on(derived);
    return DerivedVolume{std::move(made), std::move(derived->notes)};
}

level2::Sweep dealiased_sweep(const level2::Sweep& sweep, Dealiasing rung,
                              std::span<const level2::Sweep> known,
                              std::span<const Moment> wanted) {
    level2::Volume alone;
    alone.sweeps.push_back(velocities_of(sweep));
    const auto dealiased = add_dealiased_velocity(alone, rung, known);
    // Both calls fail only if the sweep has no velocities that can be dealiased.
    if (dealiased) (void)add_shear_moments(alone, *dealiased, wanted);
    return std::move(alone.sweeps.front());
}

std::optional<Motion> motion_in_notes(std::span<const std::string> notes) {
    const auto text = text_in_notes(notes, motion_words);
    if (!text) return std::nullopt;
    const auto motion = parse_motion(*text);
    return motion ? std::optional{*motion} : std::nullopt;
}

std::string quality_in_notes(std::span<const std::string> notes) {
    if (const auto text = text_in_notes(notes, quality_words, '\n')) return quality_words + *text;
    // The sites of a mosaic have different shares.
    std::string least;
    double lowest = 100, highest = 0;
    for (const std::string& note : notes) {
        const std::size_t at = note.find(quality_words);
        if (at == note.npos) continue;
        const std::size_t end = note.find("; ", at);
        if (least.empty()) least = note.substr(at, end - at);
        if (end == note.npos) continue;
        const double percent = std::strtod(note.c_str() + end + 2, nullptr);
        lowest = std::min(lowest, percent);
        highest = std::max(highest, percent);
    }
    if (lowest > highest) return least;
    return fmt::format("{}; {:.0f} to {:.0f} % of the echo left out", least, lowest, highest);
}

std::string dealiasing_in_notes(std::span<const std::string> notes) {
    return text_in_notes(notes, shear_words).value_or("");
}

}  // namespace stormcellar::retrieve
