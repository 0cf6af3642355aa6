#include "web/http/answer.h"

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/printable.h"

namespace stormcellar::web {

std::uint64_t size_of(const Piece& piece) {
    if (const auto* text = std::get_if<Text>(&piece)) return (*text)->size();
    return std::get<FileSlice>(piece).size;
}

std::uint64_t size_of(const Pieces& pieces) {
    std::uint64_t size = 0;
    for (const Piece& piece : pieces)
        size += size_of(piece);
    return size;
}

Pieces part_of(const Pieces& pieces, std::uint64_t offset, std::uint64_t size) {
    Pieces part;
    for (const Piece& piece : pieces) {
        const std::uint64_t length = size_of(piece);
        const std::uint64_t skipped = std::min(offset, length);
        const std::uint64_t taken = std::min(size, length - skipped);
        offset -= skipped;
        size -= taken;
        if (taken == 0) continue;
        if (taken == length) {
            part.push_back(piece);
        } else if (const auto* text = std::get_if<Text>(&piece)) {
            part.emplace_back(text_of((*text)->substr(skipped, taken)));
        } else if (const auto* slice = std::get_if<FileSlice>(&piece)) {
            part.emplace_back(
                FileSlice{slice->file, slice->offset + skipped, taken, slice->memory_bytes});
        }
    }
    return part;
}

Answer text_answer(unsigned status, std::string content_type, std::string body) {
    Answer answer;
    answer.status = status;
    answer.with("Content-Type", std::move(content_type));
    answer.body = Pieces{text_of(std::move(body))};
    return answer;
}

Answer sentence(unsigned status, std::string_view text) {
    return text_answer(status, "text/plain; charset=utf-8", std::string(text) + "\n");
}

Answer json_error(unsigned status, std::string_view text) {
    const nlohmann::json error = {{"error", printable(text)}};
    return text_answer(status, "application/json", error.dump() + "\n");
}

unsigned status_of(const Error& error) {
    switch (error.code) {
        case ErrorCode::not_found:
            return 404;
        case ErrorCode::bad_argument:
            return 400;
        case ErrorCode::busy:
        case ErrorCode::exhausted:
        case ErrorCode::over_budget:
        case ErrorCode::no_space:
        case ErrorCode::unmet:
            return 503;
        default:
            return 500;
    }
}

// Replaces paths in a message. A path begins with a slash at the start of a word. Names of files
// may hold blanks, so a path ends only at ": " or with the message.
std::string without_paths(std::string_view message) {
    std::string out;
    while (!message.empty()) {
        const bool begins_word =
            out.empty() || std::string_view{" '\"("}.find(out.back()) != std::string_view::npos;
        if (message.front() != '/' || !begins_word) {
            out += message.front();
            message.remove_prefix(1);
            continue;
        }
        out += "a file";
        message.remove_prefix(std::min(message.find(": "), message.size()));
    }
    return out;
}

Answer with_trouble(Answer answer, const Error& error) {
    if (answer.status >= 500) answer.trouble = error.message;
    return answer;
}

Answer json_error(const Error& error) {
    Answer answer = json_error(status_of(error), without_paths(error.message));
    if (answer.status == 503) answer.with("Retry-After", "5");
    return with_trouble(std::move(answer), error);
}

Answer moved_to(const Request& request, std::string_view path) {
    std::string target;
    for (const std::string_view segment : segments_of(path))
        target += "/" + encoded(segment);
    if (target.empty() || path.back() == '/') target += '/';
    return sentence(308, "This is at " + target).with("Location", request.base + target);
}

Answer come_back(std::chrono::seconds after, std::string_view text) {
    return sentence(503, text).with("Retry-After", std::to_string(after.count()));
}

std::string xml_escaped(std::string_view text) {
    std::string out;
    for (const char c : text) {
        switch (c) {
            case '<':
                out += "&lt;";
                break;
            case '>':
                out += "&gt;";
                break;
            case '&':
                out += "&amp;";
                break;
            case '"':
                out += "&quot;";
                break;
            case '\'':
                out += "&#39;";
                break;
            default:
                if (static_cast<unsigned char>(c) < 0x20 && c != '\n' && c != '\t')
                    out += "\xEF\xBF\xBD";
                else
                    out += c;
        }
    }
    return out;
}

}  // namespace stormcellar::web
