#include "cli/shared/input_files.h"

#include <algorithm>
#include <cerrno>
#include <map>
#include <optional>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <unistd.h>

#include "base/system_error.h"
#include "cli/shared/commands.h"
#include "stormcellar/archive/archive_reader.h"
#include "stormcellar/base/descriptor.h"
#include "stormcellar/base/file_system.h"
#include "stormcellar/base/station_table.h"
#include "stormcellar/level2/chunk_directory.h"
#include "stormcellar/level2/chunk_name.h"

namespace stormcellar::cli {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view standard_input = "standard input";
constexpr std::uint64_t most_piped_bytes = std::uint64_t{4} << 30;

// Reads all bytes of a source, such as a pipe, that can only be read once.
Result<std::vector<std::byte>> read_piped(int descriptor, std::string_view label) {
    std::vector<std::byte> bytes;
    for (;;) {
        const std::size_t at = bytes.size();
        if (at > most_piped_bytes) {
            return fail(ErrorCode::unsupported, "{}: holds more than the limit of {} bytes", label,
                        most_piped_bytes);
        }
        bytes.resize(at + (std::size_t{1} << 20));
        const ssize_t got = ::read(descriptor, bytes.data() + at, bytes.size() - at);
        if (got < 0 && errno != EINTR) {
            return fail(ErrorCode::io, "{}: {}", label, std::system_category().message(errno));
        }
        bytes.resize(at + static_cast<std::size_t>(std::max<ssize_t>(got, 0)));
        if (got == 0) return bytes;
    }
}

}  // namespace

// An archive that is read member by member.
class OpenArchive {
  public:
    // Opens an archive. Returns none if the file is not an archive. `piped` has the file's bytes if
    // they came through a pipe. Errors: those of opening the archive.
    static Result<std::unique_ptr<OpenArchive>> open(const fs::path& path,
                                                     const std::vector<std::byte>* piped) {
        auto opened = std::make_unique<OpenArchive>();
        if (piped != nullptr) {
            opened->reader_ = archive::ArchiveReader::open(*piped);
        } else {
            opened->file_ = Descriptor{::open(path.c_str(), O_RDONLY | O_CLOEXEC)};
            if (!opened->file_.is_open()) return system_failure(path.native(), errno);
            opened->reader_ = archive::ArchiveReader::open(opened->file_.number());
        }
        if (!opened->reader_) return nullptr;
        return opened;
    }
    [[nodiscard]] archive::ArchiveReader& reader() { return *reader_; }

  private:
    Descriptor file_{-1};
    std::optional<archive::ArchiveReader> reader_;
};

namespace {

bool is_hidden(const fs::path& path) {
    return path.filename().native().starts_with('.');
}

// For the name of a chunk, returns the directory and the part of the name that all chunks of its
// volume share. Returns an empty path for any other file.
fs::path volume_of_chunk(const std::string& name) {
    const fs::path path{name};
    const std::string file = path.filename().native();
    const auto placed = level2::place_chunk_name(file);
    std::error_code error;
    if (!placed || !fs::is_regular_file(path, error)) return {};
    return path.parent_path() / file.substr(0, placed->number_at);
}

}  // namespace

std::string InputFile::file_name() const {
    if (path.empty() && member.empty()) return label;
    return member.empty() ? path.filename().string() : fs::path{member}.filename().string();
}

struct InputFiles::Impl {
    std::vector<InputFile> files;
    std::vector<std::string> left_out;
    // The bytes that came through pipes, by the path of the pipe. Standard input has an empty path.
    std::map<fs::path, std::vector<std::byte>> piped;
    // The archive that was read last, and the position in it.
    std::unique_ptr<OpenArchive> open;
    fs::path open_path;

    int volume = InputFiles::newest;

    Status add(const std::string& name);
    Status add_piped(const std::string& label, const fs::path& path, int descriptor);
    Status add_directory(const fs::path& directory);
    Status add_chunks(const fs::path& directory, const std::vector<level2::ChunkSet>& sets);
    void add_named_chunks(std::vector<std::string>& names);
    // Adds the members of an archive. Returns false if the file is not an archive.
    bool add_archive(const std::string& label, const fs::path& path);
    Result<std::vector<std::byte>> read_member(const InputFile& file);
    // Returns the file's bytes if they came through a pipe. Returns null if the file must be read
    // from its path.
    [[nodiscard]] const std::vector<std::byte>* piped_of(const fs::path& path) const {
        const auto found = piped.find(path);
        return found == piped.end() ? nullptr : &found->second;
    }
};

bool InputFiles::Impl::add_archive(const std::string& label, const fs::path& path) {
    auto opened = OpenArchive::open(path, piped_of(path));
    if (!opened || !*opened) return false;  // read() will report the reason
    const std::unique_ptr<OpenArchive>& archive = *opened;
    while (const auto member = archive->reader().next()) {
        files.push_back(
            {fmt::format("{}{}{}", label, member_mark, member->name), path, member->name, true});
    }
    for (const archive::LeftOut& one : archive->reader().left_out()) {
        left_out.push_back(
            one.name.empty() ? fmt::format("{}: {}", label, one.reason)
                             : fmt::format("{}{}{}: {}", label, member_mark, one.name, one.reason));
    }
    return true;
}

Status InputFiles::Impl::add_piped(const std::string& label, const fs::path& path, int descriptor) {
    if (piped.contains(path)) {
        return fail(ErrorCode::bad_argument, "{}: can be read only once", label);
    }
    auto bytes = read_piped(descriptor, label);
    if (!bytes) return pass_on(bytes);
    piped[path] = std::move(*bytes);
    if (!add_archive(label, path)) files.push_back({label, path, {}, false});
    return {};
}

Status InputFiles::Impl::add_chunks(const fs::path& directory,
                                    const std::vector<level2::ChunkSet>& sets) {
    InputFile file{directory.native(), directory, {}, false};
    const auto count = static_cast<int>(sets.size());
    if (volume > count) {
        return fail(ErrorCode::bad_argument, "--volume {}: {} holds chunks of only {} {}", volume,
                    directory.native(), count, plural(sets.size(), "volume"));
    }
    const int number = volume > 0 ? volume : count;
    if (volume == InputFiles::newest && count > 1) {
        left_out.push_back(
            fmt::format("{}: holds chunks of {} volumes, and number {} is the "
                        "newest; --volume 1 to {} chooses",
                        directory.native(), count, number, count));
    }
    for (int i = 1; i <= count; ++i) {
        if (volume != InputFiles::all && i != number) continue;
        const auto& chunks = sets[static_cast<std::size_t>(i - 1)].chunks;
        file.chunks.insert(file.chunks.end(), chunks.begin(), chunks.end());
    }
    files.push_back(std::move(file));
    return {};
}

// Adds the volumes that have several chunks among the names, and removes these chunks from the
// names.
void InputFiles::Impl::add_named_chunks(std::vector<std::string>& names) {
    std::map<fs::path, std::map<int, fs::path>> volumes;
    for (const std::string& name : names) {
        const fs::path common = volume_of_chunk(name), path{name};
        if (common.empty()) continue;
        const auto chunk = level2::parse_chunk_name(path.filename().native());
        volumes[common].emplace(chunk->number, path);
    }
    std::erase_if(volumes, [](const auto& chunks) { return chunks.second.size() < 2; });
    std::erase_if(names, [&](const auto& name) { return volumes.contains(volume_of_chunk(name)); });
    for (auto& [common, chunks] : volumes) {
        const bool is_here = !common.has_parent_path();
        InputFile file{common.native() + "*", is_here ? "." : common.parent_path(), {}, false};
        for (auto& [number, path] : chunks)
            file.chunks.push_back(std::move(path));
        files.push_back(std::move(file));
    }
}

Status InputFiles::Impl::add_directory(const fs::path& directory) {
    const auto sets = level2::chunk_sets(directory);
    if (sets) return add_chunks(directory, *sets);
    std::vector<fs::path> found;
    std::error_code error;
    for (fs::recursive_directory_iterator walk{directory, error}, end; !error && walk != end;
         walk.increment(error)) {
        std::error_code ignored;
        if (!is_hidden(walk->path()) && walk->is_regular_file(ignored)) {
            found.push_back(walk->path());
        }
    }
    if (error) return fail(ErrorCode::io, "{}: {}", directory.native(), error.message());
    std::sort(found.begin(), found.end());
    for (const fs::path& path : found) {
        if (!add_archive(path.native(), path)) files.push_back({path.native(), path, {}, true});
    }
    return {};
}

Status InputFiles::Impl::add(const std::string& name) {
    if (name == "-") return add_piped(std::string{standard_input}, {}, STDIN_FILENO);
    const fs::path path{name};
    std::error_code error;
    if (fs::is_directory(path, error)) return add_directory(path);
    if (const auto member = archive::member_path_of(path)) {
        files.push_back({name, member->archive, member->member, false});
        return {};
    }
    if (fs::is_fifo(path, error) || fs::is_character_file(path, error)) {
        const Descriptor pipe{::open(path.c_str(), O_RDONLY | O_CLOEXEC)};
        if (!pipe.is_open()) {
            return fail(ErrorCode::io, "{}: {}", name, std::system_category().message(errno));
        }
        return add_piped(name, path, pipe.number());
    }
    if (!fs::is_regular_file(path, error) || !add_archive(name, path)) {
        files.push_back({name, path, {}, false});
    }
    return {};
}

Result<std::vector<std::byte>> InputFiles::Impl::read_member(const InputFile& file) {
    // First look for the member after the one that was read last. If it is not there, start from
    // the beginning.
    for (int attempt = 0; attempt < 2; ++attempt) {
        if (!open || open_path != file.path || attempt > 0) {
            auto opened = OpenArchive::open(file.path, piped_of(file.path));
            if (!opened) return pass_on(opened);
            open = std::move(*opened);
            open_path = file.path;
            attempt = 1;
        }
        while (open) {
            auto member = open->reader().next();
            if (!member) break;
            if (member->name == file.member) return std::move(member->bytes);
        }
    }
    const auto read = std::exchange(open, {});
    return fail(
        ErrorCode::not_found, "{}: {}", file.label,
        read ? read->reader().why_missing(file.member) : "is in a file that is not an archive");
}

InputFiles::InputFiles(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
InputFiles::InputFiles(InputFiles&&) noexcept = default;
InputFiles& InputFiles::operator=(InputFiles&&) noexcept = default;
InputFiles::~InputFiles() = default;

Result<InputFiles> InputFiles::find(std::vector<std::string> names, int volume) {
    auto impl = std::make_unique<Impl>();
    impl->volume = volume;
    impl->add_named_chunks(names);
    for (const std::string& name : names) {
        const std::size_t before = impl->files.size();
        const std::size_t left_out_before = impl->left_out.size();
        if (Status added = impl->add(name); !added) return pass_on(added);
        if (impl->files.size() == before) {
            return fail(
                ErrorCode::not_found, "{}: holds no file{}", name,
                impl->left_out.size() == left_out_before ? "" : "; " + impl->left_out.back());
        }
    }
    return InputFiles(std::move(impl));
}

const std::vector<InputFile>& InputFiles::files() const {
    return impl_->files;
}

std::vector<std::string> InputFiles::labels() const {
    std::vector<std::string> labels;
    for (const InputFile& file : impl_->files)
        labels.push_back(file.label);
    return labels;
}

bool InputFiles::is_found(const std::string& label) const {
    const auto file = std::ranges::find(impl_->files, label, &InputFile::label);
    return file != impl_->files.end() && file->was_found;
}

const std::vector<std::string>& InputFiles::left_out() const {
    return impl_->left_out;
}

void note_left_out(const InputFiles& inputs) {
    for (const std::string& one : inputs.left_out())
        print_note(fmt::format("left out: {}", one));
}

Result<std::vector<std::byte>> InputFiles::read(const InputFile& file) {
    if (!file.member.empty()) return impl_->read_member(file);
    if (const auto* const piped = impl_->piped_of(file.path)) return *piped;
    return read_file(file.path);
}

Result<level2::Decoded> InputFiles::decode(const InputFile& file, level2::DecodeOptions options,
                                           std::uint64_t* bytes) {
    if (!file.chunks.empty()) return level2::decode_chunks(file.chunks, options);
    const auto read_bytes = read(file);
    if (!read_bytes) return pass_on(read_bytes);
    if (bytes != nullptr) *bytes = read_bytes->size();
    if (options.fallback_station.empty()) {
        options.fallback_station = station_in_name(file.file_name());
    }
    auto decoded = level2::decode(*read_bytes, options);
    if (!decoded) {
        return fail(decoded.error().code, "{}: {}", file.label, decoded.error().message);
    }
    return decoded;
}

bool is_no_volume(const Error& error) {
    return error.code == ErrorCode::not_level2 || error.code == ErrorCode::empty;
}

}  // namespace stormcellar::cli
