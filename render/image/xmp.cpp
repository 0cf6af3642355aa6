#include "render/image/xmp.h"

#include <fmt/format.h>

namespace stormcellar::render {

std::string text_of(const PictureTexts& texts) {
    std::string text;
    for (const auto& [keyword, value] : texts) {
        if (!text.empty()) text += '\n';
        text += fmt::format("{}: {}", keyword, value);
    }
    return text;
}

std::string title_of(const PictureTexts& texts) {
    for (const auto& [keyword, value] : texts) {
        if (keyword == "Title") return value;
    }
    return {};
}

std::string xml_escaped(std::string_view text) {
    std::string escaped;
    for (const char c : text) {
        if (c == '&') {
            escaped += "&amp;";
        } else if (c == '<') {
            escaped += "&lt;";
        } else if (c == '>') {
            escaped += "&gt;";
        } else {
            const bool is_control = static_cast<unsigned char>(c) < 0x20 && c != '\n' && c != '\t';
            escaped += is_control ? ' ' : c;
        }
    }
    return escaped;
}

std::string xmp_packet(const PictureTexts& texts) {
    const auto property = [](const char* name, const std::string& text) {
        return fmt::format(
            "<dc:{0}><rdf:Alt><rdf:li xml:lang=\"x-default\">{1}</rdf:li></rdf:Alt>"
            "</dc:{0}>",
            name, xml_escaped(text));
    };
    std::string properties;
    if (const std::string title = title_of(texts); !title.empty()) {
        properties += property("title", title);
    }
    properties += property("description", text_of(texts));
    return fmt::format(
        "<x:xmpmeta xmlns:x=\"adobe:ns:meta/\">"
        "<rdf:RDF xmlns:rdf=\"http://www.w3.org/1999/02/22-rdf-syntax-ns#\">"
        "<rdf:Description rdf:about=\"\" xmlns:dc=\"http://purl.org/dc/elements/1.1/\">"
        "{}</rdf:Description></rdf:RDF></x:xmpmeta>",
        properties);
}

}  // namespace stormcellar::render
