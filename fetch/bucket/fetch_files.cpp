// The module stormcellar_fetch.so: lists a bucket and downloads the files that were requested.
#include <algorithm>
#include <cerrno>
#include <fstream>
#include <map>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/checksum.h"
#include "fetch/bucket/bucket_listing.h"
#include "fetch/bucket/transfers.h"
#include "stormcellar/base/descriptor.h"
#include "stormcellar/fetch/fetch.h"

namespace stormcellar::fetch {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t most_listing_bytes = std::size_t{4} << 20;  // limit for one page
// Limit of the pages that list one station and day. A page has 1,000 names, and a radar makes some
// 600 files a day.
constexpr std::size_t most_pages = 20;
constexpr std::uint64_t most_file_bytes = std::uint64_t{1} << 30;

// A file that is being downloaded. The bytes that have arrived are in a hidden file, in the
// directory for the downloaded files.
struct Download {
    BucketObject object;
    fs::path target, part;
    Descriptor file{-1};
    std::uint64_t have = 0;
    int tries = 0;
    bool too_long = false;
    std::string write_error;
};

std::string reason_of_system() {
    return std::system_category().message(errno);
}

std::uint64_t size_of(const fs::path& path) {
    std::error_code error;
    const auto size = fs::file_size(path, error);
    return error ? 0 : size;
}

void set_time(const fs::path& path, UtcTime time) {
    const std::int64_t ms = time.time_since_epoch().count();
    const timespec at{static_cast<time_t>(ms / 1000), static_cast<long>(ms % 1000) * 1'000'000};
    const timespec times[2] = {at, at};
    (void)::utimensat(AT_FDCWD, path.c_str(), times, 0);
}

// Returns the name that a file has while it is being downloaded. The name includes the tag, so that
// parts of different contents do not mix.
std::string part_name_of(const BucketObject& object) {
    const std::int64_t modified = object.modified ? object.modified->time_since_epoch().count() : 0;
    const std::string contents =
        fmt::format("{} {} {} {}", object.key, object.size_bytes, modified, object.tag);
    return fmt::format(".{}.{:016x}.part", name_of_key(object.key),
                       xxh3_64(std::as_bytes(std::span{contents})));
}

// Returns true if the tag is one quoted word. No other tag may be used, because the tag becomes
// part of a header.
bool is_plain_tag(std::string_view tag) {
    const auto is_plain = [](char c) { return c > ' ' && c < 0x7F && c != '"'; };
    return tag.size() > 2 && tag.front() == '"' && tag.back() == '"' &&
           std::ranges::all_of(tag.substr(1, tag.size() - 2), is_plain);
}

// Returns true for a name that a raw file may have: letters, digits, '_', '-', and dots that are
// not at its ends.
bool is_plain_name(std::string_view name) {
    const auto is_plain = [](char c) {
        return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') ||
               c == '_' || c == '-' || c == '.';
    };
    return !name.empty() && name.front() != '.' && std::ranges::all_of(name, is_plain);
}

class Fetching {
  public:
    Fetching(const FetchRequest& request, Transfers& transfers)
        : request_(request), transfers_(transfers) {}

    FetchReport run() {
        for (const std::string& prefix : prefixes_of(request_.stations, request_.from, request_.to))
            list(prefix, {}, 0, 0);
        transfers_.run(request_.stop, [this] { report_progress(); });
        report_.stopped = request_.stop != nullptr && *request_.stop;
        report_progress();
        return std::move(report_);
    }

  private:
    void report_progress() {
        if (!request_.progress) return;
        request_.progress(
            {report_.fetched + report_.present + failed_files_, report_.found, report_.bytes});
    }
    [[nodiscard]] std::chrono::milliseconds wait_before(int tries) const {
        return request_.first_wait * (1 << std::min(tries, 8));
    }

    void list(const std::string& prefix, const std::string& token, std::size_t page, int tries) {
        auto body = std::make_shared<std::vector<std::byte>>();
        Transfer transfer;
        transfer.url = listing_url(request_.source, prefix, token);
        transfer.begin = [body](std::uint64_t) {
            body->clear();
            return true;
        };
        transfer.take = [body](const std::byte* bytes, std::size_t count) {
            body->insert(body->end(), bytes, bytes + count);
            return body->size() <= most_listing_bytes;
        };
        transfer.ended = [this, body, prefix, token, page,
                          tries](const Transfer::Outcome& outcome) {
            auto listing = outcome.good
                               ? parse_listing(*body)
                               : Result<ListingPage>{fail(ErrorCode::io, "{}", outcome.reason)};
            // The listing may have been cut in transfer, so ask for it again.
            const bool again = outcome.good ? !listing : outcome.may_be_tried_again;
            if (!listing && again && tries + 1 < request_.tries) {
                list(prefix, token, page, tries + 1);
                return;
            }
            if (!listing) {
                report_.failures.push_back({prefix, listing.error().message});
                return;
            }
            for (BucketObject& object : listing->objects)
                take(prefix, std::move(object));
            if (listing->next_token.empty()) return;
            if (page + 1 == most_pages) {
                report_.failures.push_back({prefix, "its listing does not end"});
                return;
            }
            list(prefix, listing->next_token, page + 1, 0);
        };
        transfers_.add(std::move(transfer),
                       tries == 0 ? std::chrono::milliseconds{0} : wait_before(tries - 1));
    }

    // Takes an object of a listing. A listing may also name objects that were not requested.
    void take(const std::string& prefix, BucketObject object) {
        const std::string name{name_of_key(object.key)};
        const auto start = start_in_name(name);
        const bool is_wanted = object.key.starts_with(prefix) && is_plain_name(name) && start &&
                               *start >= request_.from && *start <= request_.to;
        if (!is_wanted || !taken_.insert({name, object.key}).second) return;
        if (is_metadata_name(name)) {
            ++report_.without_radials;
            return;
        }
        ++report_.found;
        if (object.size_bytes > most_file_bytes) {
            fail_for_good(
                object.key,
                fmt::format("it has {} bytes, more than any volume has", object.size_bytes), true);
            return;
        }
        auto download = std::make_shared<Download>();
        download->target = request_.directory / name;
        download->part = request_.directory / part_name_of(object);
        download->object = std::move(object);
        if (size_of(download->target) == download->object.size_bytes) {
            ++report_.present;
            return;
        }
        get(download);
    }

    void fail_for_good(const std::string& key, std::string reason, bool is_refused = false) {
        ++failed_files_;
        report_.failures.push_back({key, std::move(reason), is_refused});
    }

    void get(const std::shared_ptr<Download>& download) {
        Transfer transfer;
        transfer.url = object_url(request_.source, download->object.key);
        download->have = size_of(download->part);
        if (download->have >= download->object.size_bytes) download->have = 0;
        transfer.from_byte = download->have;
        if (is_plain_tag(download->object.tag)) transfer.tag = download->object.tag;
        transfer.begin = [download](std::uint64_t from) {
            const int flags =
                O_WRONLY | O_CREAT | O_CLOEXEC | O_NOFOLLOW | (from == 0 ? O_TRUNC : 0);
            download->file = Descriptor{::open(download->part.c_str(), flags, 0644)};
            download->have = from;
            return download->file.is_open() &&
                   ::lseek(download->file.number(), static_cast<off_t>(from), SEEK_SET) >= 0;
        };
        transfer.take = [this, download](const std::byte* bytes, std::size_t count) {
            if (download->have + count > download->object.size_bytes) {
                download->too_long = true;
                return false;
            }
            while (count > 0) {
                const ssize_t done = ::write(download->file.number(), bytes, count);
                if (done < 0 && errno == EINTR) continue;
                if (done < 0) {
                    download->write_error = reason_of_system();
                    return false;
                }
                bytes += done;
                count -= static_cast<std::size_t>(done);
                download->have += static_cast<std::uint64_t>(done);
                report_.bytes += static_cast<std::uint64_t>(done);
            }
            return true;
        };
        transfer.ended = [this, download](const Transfer::Outcome& outcome) {
            ended(download, outcome);
        };
        transfers_.add(std::move(transfer), download->tries == 0
                                                ? std::chrono::milliseconds{0}
                                                : wait_before(download->tries - 1));
    }

    void ended(const std::shared_ptr<Download>& download, const Transfer::Outcome& outcome) {
        download->file = Descriptor{-1};
        const BucketObject& object = download->object;
        std::string reason = outcome.reason;
        bool again = outcome.may_be_tried_again;
        bool is_refused = outcome.is_refused;
        std::error_code ignored;
        if (outcome.part_is_useless) fs::remove(download->part, ignored);
        if (std::exchange(download->too_long, false)) {
            reason = fmt::format("it has more than the {} bytes that the listing says",
                                 object.size_bytes);
            again = true;
            is_refused = false;
            fs::remove(download->part, ignored);
        } else if (const std::string trouble = std::exchange(download->write_error, {});
                   !trouble.empty()) {
            reason = fmt::format("{}: {}", download->part.native(), trouble);
        } else if (outcome.good && download->have < object.size_bytes) {
            reason =
                fmt::format("only {} of its {} bytes arrived", download->have, object.size_bytes);
            again = true;
        } else if (outcome.good) {
            keep(*download, outcome);
            return;
        }
        if (again && ++download->tries < request_.tries) {
            get(download);
            return;
        }
        fail_for_good(object.key, reason, is_refused);
    }

    void keep(const Download& download, const Transfer::Outcome& outcome) {
        const auto modified = outcome.modified ? outcome.modified : download.object.modified;
        if (modified) set_time(download.part, *modified);
        if (::rename(download.part.c_str(), download.target.c_str()) != 0) {
            fail_for_good(download.object.key,
                          fmt::format("{}: {}", download.target.native(), reason_of_system()));
            return;
        }
        ++report_.fetched;
    }

    const FetchRequest& request_;
    Transfers& transfers_;
    FetchReport report_;
    std::map<std::string, std::string> taken_;  // keys of the files that were taken, by file name
    std::size_t failed_files_ = 0;
};

Result<FetchReport> fetch_files(const FetchRequest& request) {
    if (!request.source.starts_with("http://") && !request.source.starts_with("https://")) {
        return fail(ErrorCode::bad_argument,
                    "{}: the source must be an address that begins with http", request.source);
    }
    std::error_code error;
    fs::create_directories(request.directory, error);
    if (error) return fail(ErrorCode::io, "{}: {}", request.directory.native(), error.message());
    if (::access(request.directory.c_str(), W_OK) != 0) {
        return fail(ErrorCode::permission, "{}: {}", request.directory.native(),
                    reason_of_system());
    }
    auto transfers = Transfers::make({request.parallel, request.stall});
    if (!transfers) return pass_on(transfers);
    return Fetching(request, **transfers).run();
}

}  // namespace
}  // namespace stormcellar::fetch

extern "C" __attribute__((visibility("default"))) void stormcellar_fetch_files(
    const stormcellar::fetch::FetchRequest& request,
    stormcellar::Result<stormcellar::fetch::FetchReport>& report) {
    report = stormcellar::fetch::fetch_files(request);
}
