#include "cli/grid/volume_source.h"

#include <algorithm>
#include <filesystem>
#include <memory>
#include <utility>

#include "base/steady_time.h"
#include "level2/decode/volume_checks.h"
#include "stormcellar/level2/chunk_directory.h"
#include "stormcellar/retrieve/melting_layer.h"

namespace stormcellar::cli {
namespace {

// Adds the derived moments. If the request accepts any moment, a volume without velocities is no
// error.
Result<std::vector<std::string>> add_derived(const GridRequest& request, level2::Volume& volume) {
    const auto moments = request.moments();
    retrieve::DerivedOptions options = request.derived;
    if (request.plan_dealiasing) {
        const auto rung = request.plan_dealiasing(volume);
        if (!rung) return pass_on(rung);
        options.dealiasing = *rung;
    }
    auto derived = retrieve::add_derived_moments(volume, moments, options);
    if (derived) return std::move(derived->notes);
    if (request.any_moment) return std::vector<std::string>{};
    const bool lacks_motion = std::ranges::find(moments, level2::Moment::srv) != moments.end() &&
                              level2::holds(volume, level2::Moment::vel);
    return fail(derived.error().code, "{}{}", derived.error().message,
                lacks_motion ? "; give the motion, as in --storm-motion 240/15" : "");
}

// Adds the derived moments, if there are any, and compares the melting layer with the height that
// the request assumes.
Result<std::vector<std::string>> complete(const GridRequest& request, level2::Volume& volume) {
    const std::string note = request.assumed_zero_c_m
                                 ? retrieve::zero_c_note(volume, *request.assumed_zero_c_m)
                                 : std::string{};
    Result<std::vector<std::string>> notes;
    if (retrieve::must_derive(request.moments(), request.derived))
        notes = add_derived(request, volume);
    if (notes && !note.empty()) notes->push_back(note);
    return notes;
}

// Returns what must be decoded for a request. The request must outlive the result.
grid::SourceWish wish_of(const GridRequest& request, const ChooseCuts& choose_cuts) {
    grid::SourceWish wish{
        .moments = request.moments(),
        .choose_cuts = choose_cuts,
        .place = [&request](level2::Volume& volume) { return apply_site(request.site, volume); },
        .how_to_place = how_to_place,
        .threads = request.threads};
    if (retrieve::must_derive(wish.moments, request.derived) || request.assumed_zero_c_m) {
        wish.choose_cuts = {};  // all cuts help to dealias and to judge a cut
        wish.needs_all_moments = request.derived.quality > 0 || request.assumed_zero_c_m;
        wish.derive = [&request](level2::Volume& volume) { return complete(request, volume); };
    }
    return wish;
}

struct ReadVolume {
    level2::Decoded decoded;
    double read_s = 0, decode_s = 0;
};

Result<ReadVolume> read_and_decode(InputFiles& inputs, const InputFile& file,
                                   const grid::SourceWish& wish) {
    Stopwatch watch;
    const level2::DecodeOptions options = grid::decode_options_of(wish, file.file_name());
    if (!file.chunks.empty()) {
        auto joined = level2::decode_chunks(file.chunks, options);
        if (!joined) return pass_on(joined);
        return ReadVolume{std::move(*joined), 0, watch.lap_s()};
    }
    const auto bytes = inputs.read(file);
    const double read_s = watch.lap_s();
    if (!bytes) return pass_on(bytes);
    auto decoded = grid::decode_wished(*bytes, file.label, options, wish.choose_cuts);
    if (!decoded) return pass_on(decoded);
    return ReadVolume{std::move(*decoded), read_s, watch.lap_s()};
}

}  // namespace

Result<SourceVolume> load_volume(const std::string& file, const GridRequest& request,
                                 const ChooseCuts& choose_cuts) {
    std::shared_ptr<InputFiles> inputs = request.inputs;
    if (!inputs) {
        auto found = InputFiles::find({file}, request.volume);
        if (!found) return pass_on(found);
        inputs = std::make_shared<InputFiles>(std::move(*found));
    }
    const auto& files = inputs->files();
    const auto named = std::ranges::find(files, file, &InputFile::label);
    if (named == files.end()) {
        return fail(ErrorCode::bad_argument, "{}: holds several files; name one of them", file);
    }
    grid::SourceWish wish = wish_of(request, choose_cuts);
    // For a directory of chunks, InputFiles has already chosen the volume.
    if (named->chunks.empty()) wish.volume = request.volume;
    // Volumes are counted by their sweeps, and a volume may have none of the chosen cuts. So decode
    // all cuts if the volume is chosen by its number.
    if (wish.volume > 0) wish.choose_cuts = {};
    auto read = read_and_decode(*inputs, *named, wish);
    if (!read) return pass_on(read);
    auto source = grid::take_source(std::move(read->decoded), file, wish);
    if (!source) return source;
    source->read_s = read->read_s;
    source->decode_s = read->decode_s;
    return source;
}

Result<SourceVolume> decode_volume(std::span<const std::byte> bytes, const std::string& file,
                                   const GridRequest& request, UtcTime start,
                                   const ChooseCuts& choose_cuts) {
    grid::SourceWish wish = wish_of(request, choose_cuts);
    wish.start = start;
    return grid::decode_source(bytes, file, wish);
}

}  // namespace stormcellar::cli
