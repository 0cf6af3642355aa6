// Reads members of archives by their names.
#include <cerrno>
#include <string>
#include <system_error>
#include <utility>

#include <fcntl.h>

#include "base/system_error.h"
#include "stormcellar/archive/archive_reader.h"
#include "stormcellar/base/file_system.h"

namespace stormcellar::archive {

std::optional<MemberName> member_path_of(const std::filesystem::path& path) {
    std::error_code error;
    std::vector<MemberName> names = member_names_in(path);
    if (names.empty() || std::filesystem::exists(path, error)) return std::nullopt;
    for (MemberName& name : names) {
        if (std::filesystem::is_regular_file(name.archive, error)) return std::move(name);
    }
    return std::nullopt;
}

Result<Member> find_member(int descriptor, const std::string& name, Limits limits) {
    auto reader = ArchiveReader::open(descriptor, limits);
    if (!reader) return fail(ErrorCode::corrupt, "is in a file that is no longer an archive");
    while (auto member = reader->next()) {
        if (member->name == name) return std::move(*member);
    }
    const ErrorCode code = reader->is_unreadable() ? ErrorCode::io : ErrorCode::corrupt;
    return fail(code, "{}", reader->why_missing(name));
}

Result<std::vector<std::byte>> SourceReader::read(const std::filesystem::path& path) {
    const auto name = member_path_of(path);
    if (!name) return read_file(path);
    // Search from the place after the last member that was read, and then once more from the start.
    for (int attempt = 0; attempt < 2; ++attempt) {
        if (!reader_ || archive_ != name->archive || attempt > 0) {
            reader_.reset();
            archive_ = name->archive;
            file_ = Descriptor{::open(archive_.c_str(), O_RDONLY | O_CLOEXEC)};
            if (!file_.is_open()) return system_failure(archive_.native(), errno);
            reader_ = ArchiveReader::open(file_.number());
            attempt = 1;
        }
        while (reader_) {
            auto member = reader_->next();
            if (!member) break;
            if (member->name == name->member) return std::move(member->bytes);
        }
    }
    const auto read = std::exchange(reader_, std::nullopt);
    return fail(ErrorCode::not_found, "{}: {}", path.native(),
                read ? read->why_missing(name->member) : "is in a file that is not an archive");
}

}  // namespace stormcellar::archive
