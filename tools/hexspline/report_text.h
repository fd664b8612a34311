/// \file report_text.h
/// Text of any bytes inside of other formats: names of files need not be UTF-8.
#pragma once

#include <string>

namespace cli {

/// UTF-8 that XML 1.0 allows (section 2.2 of the standard): every byte that is no UTF-8, and every character
/// that XML forbids (control characters, U+FFFE, U+FFFF), becomes U+FFFD.
std::string clean_text(const std::string& text);

/// Inside an element or attribute of XML.
std::string xml_text(const std::string& text);

/// Inside a cell of a Markdown table, or any other single line of Markdown.
std::string markdown_cell(const std::string& text);

/// A path as a relative or absolute URI (RFC 3986); bytes stay what they are.
std::string uri_of(const std::string& path);

}  // namespace cli
