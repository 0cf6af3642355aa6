// render/image/xmp.h -- the metadata of pictures as text, and as XMP, which JPEG and WebP hold.
//
// Source    ISO 16684-1 (XMP), with Dublin Core properties as language alternatives.
// Threads   Pure functions.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace stormcellar::render {

using PictureTexts = std::vector<std::pair<std::string, std::string>>;  // keywords and texts

// Returns all texts as one: "Title: KTLX\nSource: ...".
[[nodiscard]] std::string text_of(const PictureTexts& texts);
// Returns the text of the keyword "Title", which may be empty.
[[nodiscard]] std::string title_of(const PictureTexts& texts);

// Returns the text as the content of an XML element. Control characters, which XML 1.0 does not
// allow, become blanks.
[[nodiscard]] std::string xml_escaped(std::string_view text);

// Returns a packet with the title as dc:title and all texts as dc:description.
[[nodiscard]] std::string xmp_packet(const PictureTexts& texts);

}  // namespace stormcellar::render
