#include "web/http/response.h"

#include <algorithm>
#include <cstring>
#include <exception>
#include <utility>

#include <fcntl.h>
#include <unistd.h>

namespace stormcellar::web {
namespace {

constexpr std::size_t block_bytes = 64 * 1024;
constexpr std::size_t stream_block_bytes = 8 * 1024;

void let_text_go(void* text) {
    delete static_cast<Text*>(text);
}

HttpResponse response_of_text(const Text& text) {
    auto held = std::make_unique<Text>(text);
    // libmicrohttpd does not change the bytes, but its interface does not say const.
    HttpResponse response(MHD_create_response_from_buffer_with_free_callback_cls(
        text->size(), const_cast<char*>(text->data()), &let_text_go, held.get()));
    if (response != nullptr) (void)held.release();
    return response;
}

HttpResponse response_of_file(const FileSlice& slice) {
    const int copy = ::fcntl(slice.file->number(), F_DUPFD_CLOEXEC, 3);
    if (copy < 0) return nullptr;
    HttpResponse response(MHD_create_response_from_fd_at_offset64(slice.size, copy, slice.offset));
    if (response == nullptr) ::close(copy);
    return response;
}

// Reads pieces one after another. Ends the connection if a file has become shorter than it was.
ssize_t read_pieces(void* pieces, std::uint64_t position, char* buffer, std::size_t most) try {
    const Pieces part = part_of(*static_cast<const Pieces*>(pieces), position, most);
    std::size_t filled = 0;
    for (const Piece& piece : part) {
        if (const auto* text = std::get_if<Text>(&piece)) {
            std::memcpy(buffer + filled, (*text)->data(), (*text)->size());
            filled += (*text)->size();
            continue;
        }
        const auto& slice = std::get<FileSlice>(piece);
        const ssize_t count = ::pread(slice.file->number(), buffer + filled, slice.size,
                                      static_cast<off_t>(slice.offset));
        if (count <= 0) break;
        filled += static_cast<std::size_t>(count);
        if (static_cast<std::uint64_t>(count) < slice.size) break;
    }
    return filled > 0 ? static_cast<ssize_t>(filled) : MHD_CONTENT_READER_END_WITH_ERROR;
} catch (const std::exception&) {
    return MHD_CONTENT_READER_END_WITH_ERROR;  // no exception may enter libmicrohttpd
}

void let_pieces_go(void* pieces) {
    delete static_cast<Pieces*>(pieces);
}

HttpResponse response_of_pieces(const Pieces& pieces) {
    if (pieces.empty())
        return HttpResponse(MHD_create_response_from_buffer(0, nullptr, MHD_RESPMEM_PERSISTENT));
    if (pieces.size() == 1) {
        if (const auto* text = std::get_if<Text>(&pieces.front())) return response_of_text(*text);
        return response_of_file(std::get<FileSlice>(pieces.front()));
    }
    auto held = std::make_unique<Pieces>(pieces);
    HttpResponse response(MHD_create_response_from_callback(
        size_of(pieces), block_bytes, &read_pieces, held.get(), &let_pieces_go));
    if (response != nullptr) (void)held.release();
    return response;
}

using HeldFeed = std::shared_ptr<StreamFeed>;

ssize_t read_feed(void* feed, std::uint64_t /*position*/, char* buffer, std::size_t most) try {
    return (*static_cast<HeldFeed*>(feed))->read(buffer, most);
} catch (const std::exception&) {
    return MHD_CONTENT_READER_END_WITH_ERROR;
}

void let_feed_go(void* feed) {
    const std::unique_ptr<HeldFeed> held(static_cast<HeldFeed*>(feed));
    (*held)->leave();
}

HttpResponse response_of_stream(const std::shared_ptr<Stream>& stream, MHD_Connection* connection,
                                HeldFeed* feed) {
    *feed = std::make_shared<StreamFeed>(stream, connection);
    auto held = std::make_unique<HeldFeed>(*feed);
    HttpResponse response(MHD_create_response_from_callback(MHD_SIZE_UNKNOWN, stream_block_bytes,
                                                            &read_feed, held.get(), &let_feed_go));
    if (response == nullptr) return nullptr;
    (void)held.release();
    (*feed)->begin(*feed);
    return response;
}

// Answers HEAD for a stream. libmicrohttpd would write the end of a chunked body, but an answer to
// HEAD must have no body. So this answer is not chunked, and the connection closes after it.
HttpResponse response_without_stream() {
    const auto ends = +[](void*, std::uint64_t, char*, std::size_t) -> ssize_t {
        return MHD_CONTENT_READER_END_OF_STREAM;
    };
    HttpResponse response(MHD_create_response_from_callback(MHD_SIZE_UNKNOWN, stream_block_bytes,
                                                            ends, nullptr, nullptr));
    if (response == nullptr) return nullptr;
    MHD_set_response_options(response.get(), MHD_RF_HTTP_1_0_COMPATIBLE_STRICT, MHD_RO_END);
    return response;
}

}  // namespace

HttpResponse make_response(const Answer& answer, Verb verb, MHD_Connection* connection,
                           HeldFeed* feed) {
    HttpResponse response;
    if (const auto* pieces = std::get_if<Pieces>(&answer.body)) {
        response = response_of_pieces(*pieces);
    } else if (verb == Verb::head) {
        response = response_without_stream();
    } else {
        response =
            response_of_stream(std::get<std::shared_ptr<Stream>>(answer.body), connection, feed);
    }
    if (response == nullptr) return response;
    for (const auto& [name, value] : answer.headers)
        MHD_add_response_header(response.get(), name.c_str(), value.c_str());
    if (answer.closes) MHD_add_response_header(response.get(), "Connection", "close");
    return response;
}

}  // namespace stormcellar::web
