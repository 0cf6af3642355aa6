#include "cli/query/catalog_get.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <thread>

#include "cli/shared/commands.h"
#include "cli/shared/output_file.h"
#include "pipeline/drop/cataloged_volume.h"
#include "stormcellar/archive/archive_reader.h"
#include "stormcellar/base/file_system.h"
#include "stormcellar/level2/decode.h"

namespace stormcellar::cli {
namespace {

namespace fs = std::filesystem;
using catalog::CatalogEntry;

// A file of the archive, with the start times of those volumes in it that matched.
struct MatchedFile {
    CatalogEntry entry;
    std::vector<std::optional<UtcTime>> starts;
};

std::vector<MatchedFile> files_of(const std::vector<CatalogEntry>& entries) {
    std::vector<MatchedFile> files;
    std::map<fs::path, std::size_t> places;
    for (const CatalogEntry& entry : entries) {
        const auto [place, is_new] = places.emplace(entry.path, files.size());
        if (is_new) files.push_back({entry, {}});
        files[place->second].starts.push_back(entry.volume.start_time);
    }
    return files;
}

// The paths written in this run. They keep the run from replacing its own output.
class Targets {
  public:
    explicit Targets(const GetOptions& options) : options_(options) {}

    // Returns the path of this name in the output directory. Fails if that path may not be written.
    Result<fs::path> claim(const std::string& name) {
        fs::path to = fs::path{options_.output} / name;
        // If two files have the same name, the second gets a number.
        for (int number = 2; !taken_.insert(to).second; ++number) {
            const fs::path plain{name};
            to = fs::path{options_.output} /
                 fmt::format("{}_{}{}", plain.stem().string(), number, plain.extension().string());
        }
        if (!options_.force && fs::exists(to)) {
            return fail(ErrorCode::bad_argument, "{}: the file exists already; --force replaces it",
                        to.native());
        }
        return to;
    }

  private:
    const GetOptions& options_;
    std::set<fs::path> taken_;
};

// Returns the usual archive name of a volume's file, such as "KLOT20220317_000842".
std::string name_of_file(const CatalogEntry& entry) {
    if (!pipeline::is_of_chunks(entry)) {
        // A member of an archive keeps its own name.
        const auto member = archive::member_path_of(entry.path);
        return (member ? fs::path{member->member} : entry.path).filename().string();
    }
    // format_utc() returns a time such as 2022-03-17T00:08:42Z.
    const std::string time = format_utc(*entry.volume.start_time);
    std::string name = entry.station;
    for (const char letter : time.substr(0, 19)) {
        if (letter == 'T') name += '_';
        if (letter >= '0' && letter <= '9') name += letter;
    }
    return name;
}

// Reads the raw file of an entry. Prints notes about it on stderr.
Result<std::vector<std::byte>> read_raw(const catalog::CatalogReader& catalog,
                                        const CatalogEntry& entry) {
    auto volume = pipeline::read_cataloged_volume(catalog, entry);
    if (!volume) return pass_on(volume);
    for (const std::string& note : volume->notes)
        fmt::print(stderr, "{}\n", printable(note));
    return std::move(volume->bytes);
}

Status copy_raw(const catalog::CatalogReader& catalog, const MatchedFile& file, Targets& targets) {
    const auto to = targets.claim(name_of_file(file.entry));
    if (!to) return pass_on(to);
    const auto bytes = read_raw(catalog, file.entry);
    if (!bytes) return pass_on(bytes);
    if (auto written = write_file_atomically(real_file_system(), *to, *bytes); !written) {
        return written;
    }
    fmt::print("{}\n", printable(to->native()));
    return {};
}

// Returns the name without the ending of a compression: "KTLX19990503_235621" for
// "KTLX19990503_235621.gz".
std::string name_without_compression(const fs::path& path) {
    const std::string extension = path.extension().string();
    const bool compressed = extension == ".gz" || extension == ".bz2" || extension == ".Z";
    return (compressed ? path.stem() : path.filename()).string();
}

Result<level2::Decoded> decode_raw(const catalog::CatalogReader& catalog,
                                   const CatalogEntry& entry) {
    const auto bytes = read_raw(catalog, entry);
    if (!bytes) return pass_on(bytes);
    level2::DecodeOptions options;
    options.threads = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
    options.fallback_station = entry.station;
    auto decoded = level2::decode(*bytes, options);
    if (!decoded) {
        return fail(decoded.error().code, "{}: {}", entry.path.native(), decoded.error().message);
    }
    return decoded;
}

// Returns the numbers of the file's volumes that matched. If the file has a single volume, returns
// its number.
std::vector<std::size_t> matched_volumes(const MatchedFile& file,
                                         const std::vector<level2::Volume>& volumes) {
    std::vector<std::size_t> matched;
    for (std::size_t i = 0; i < volumes.size(); ++i) {
        const bool is_it = std::find(file.starts.begin(), file.starts.end(),
                                     volumes[i].start_time()) != file.starts.end();
        if (volumes.size() == 1 || is_it) matched.push_back(i);
    }
    return matched;
}

Status write_decoded(const catalog::CatalogReader& catalog, const MatchedFile& file,
                     Targets& targets, const VolumeExportOptions& options) {
    auto decoded = decode_raw(catalog, file.entry);
    if (!decoded) return pass_on(decoded);
    const level2::DecodeReport report = decoded->report;
    const std::vector<level2::Volume> volumes = level2::split_volumes(std::move(*decoded));
    const std::string name = name_without_compression(name_of_file(file.entry));
    const volume_export::VolumeFormat& format = format_for(options);
    const std::string_view ending = format.endings.front();
    const auto matched = matched_volumes(file, volumes);
    for (const std::size_t i : matched) {
        const auto to =
            targets.claim(volumes.size() == 1 ? fmt::format("{}{}", name, ending)
                                              : fmt::format("{}_volume{}{}", name, i + 1, ending));
        if (!to) return pass_on(to);
        auto done = export_volume(volumes, i, report, file.entry.path, *to, format, options);
        if (!done) return done;
        fmt::print("{}\n", printable(to->native()));
    }
    if (!matched.empty()) return {};
    return fail(ErrorCode::corrupt, "{}: the file holds other volumes than the catalog says",
                file.entry.path.native());
}

Status decode_to_stdout(const catalog::CatalogReader& catalog, const MatchedFile& file,
                        const VolumeExportOptions& options) {
    auto decoded = decode_raw(catalog, file.entry);
    if (!decoded) return pass_on(decoded);
    const level2::DecodeReport report = decoded->report;
    const std::vector<level2::Volume> volumes = level2::split_volumes(std::move(*decoded));
    const auto matched = matched_volumes(file, volumes);
    if (matched.size() != 1) {
        return fail(ErrorCode::bad_argument, "-o - takes one volume, but {} matched",
                    matched.size());
    }
    auto output = OutputFile::open("-");
    if (!output) return pass_on(output);
    Status written = export_volume(volumes, matched.front(), report, file.entry.path,
                                   output->path(), format_for(options), options);
    return written ? output->finish() : written;
}

// Writes a file to standard output. Fails unless exactly one file matched.
Status get_to_stdout(const catalog::CatalogReader& catalog, const std::vector<MatchedFile>& files,
                     const GetOptions& options) {
    if (files.size() != 1) {
        return fail(ErrorCode::bad_argument, "-o - takes one file, but {} matched", files.size());
    }
    if (options.decode) return decode_to_stdout(catalog, files.front(), options.exported);
    const auto bytes = read_raw(catalog, files.front().entry);
    if (!bytes) return pass_on(bytes);
    return write_output("-", *bytes);
}

}  // namespace

int get_files(const catalog::CatalogReader& catalog, const std::vector<CatalogEntry>& entries,
              const GetOptions& options) {
    if (is_stdout(options.output)) {
        const Status done = get_to_stdout(catalog, files_of(entries), options);
        return done ? exit_done : report_error(done.error());
    }
    std::error_code error;
    fs::create_directories(options.output, error);
    if (error) {
        return report_error(
            {ErrorCode::io, fmt::format("{}: {}", options.output, error.message())});
    }
    Targets targets(options);
    int status = exit_done;
    for (const MatchedFile& file : files_of(entries)) {
        const Status done = options.decode ? write_decoded(catalog, file, targets, options.exported)
                                           : copy_raw(catalog, file, targets);
        if (!done) status = report_error(done.error());
    }
    return status;
}

}  // namespace stormcellar::cli
