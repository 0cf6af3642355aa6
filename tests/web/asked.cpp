#include "tests/web/asked.h"

#include <strings.h>
#include <unistd.h>

#include "web/http/read_request.h"

namespace stormcellar::web {

Request request_for(std::string_view target, Fields headers) {
    RawRequest raw{.method = "GET",
                   .target = std::string(target),
                   .headers = std::move(headers),
                   .client = "127.0.0.1"};
    raw.headers.emplace_back("Host", "localhost:8090");
    return read_request(raw, identity_of({})).request;
}

Answer asked(Door& door, std::string_view target, Fields headers) {
    const Request request = request_for(target, std::move(headers));
    if (auto answer = door.answer_at_once(request)) return *std::move(answer);
    return door.answer(request);
}

std::string body_of(const Answer& answer) {
    std::string body;
    for (const Piece& piece : std::get<Pieces>(answer.body)) {
        if (const auto* text = std::get_if<Text>(&piece)) {
            body += **text;
            continue;
        }
        const auto& slice = std::get<FileSlice>(piece);
        std::string bytes(slice.size, '\0');
        const ssize_t count = ::pread(slice.file->number(), bytes.data(), bytes.size(),
                                      static_cast<off_t>(slice.offset));
        bytes.resize(count < 0 ? 0 : static_cast<std::size_t>(count));
        body += bytes;
    }
    return body;
}

std::string header_of(const Answer& answer, std::string_view name) {
    for (const auto& [key, value] : answer.headers) {
        if (key.size() == name.size() && ::strncasecmp(key.data(), name.data(), key.size()) == 0)
            return value;
    }
    return {};
}

}  // namespace stormcellar::web
