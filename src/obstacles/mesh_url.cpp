// SPDX-License-Identifier: BSD-3-Clause
//
// package:// and file:// URLs without ROS, so that curtain_batch reads the node's scenes.
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>
#include <system_error>
#include <vector>

#include "curtain_sim/obstacle_shape.h"

namespace curtain {
namespace {

namespace fs = std::filesystem;

/// Depth of the search below an entry of ROS_PACKAGE_PATH.
constexpr int kSearchDepth = 4;

bool startsWith(const std::string& text, const std::string& start) { return text.compare(0, start.size(), start) == 0; }

std::string trim(const std::string& text) {
  const char* const blank = " \t\r\n";
  const std::size_t first = text.find_first_not_of(blank);
  return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(blank) - first + 1);
}

/// Content of the first <name> of a package.xml, comments aside; "" without one.
std::string packageName(const fs::path& manifest) {
  std::ifstream file(manifest);
  std::string xml((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  for (std::size_t begin = xml.find("<!--"); begin != std::string::npos; begin = xml.find("<!--")) {
    const std::size_t end = xml.find("-->", begin);
    xml.erase(begin, end == std::string::npos ? std::string::npos : end + 3 - begin);
  }
  const std::size_t begin = xml.find("<name>");
  const std::size_t end = xml.find("</name>");
  return begin == std::string::npos || end == std::string::npos || end < begin
             ? ""
             : trim(xml.substr(begin + 6, end - begin - 6));
}

/// Folder of the package at or below `folder`; "" if there is none. Like rospack it skips packages' insides, hidden
/// folders and those with a CATKIN_IGNORE.
fs::path findPackage(const fs::path& folder, const std::string& name, int depth) {
  std::error_code error;
  if (fs::exists(folder / "package.xml", error)) {
    return packageName(folder / "package.xml") == name ? folder : fs::path();
  }
  if (depth == 0 || fs::exists(folder / "CATKIN_IGNORE", error)) return {};
  std::vector<fs::path> folders;
  fs::directory_iterator entry(folder, fs::directory_options::skip_permission_denied, error);
  for (; !error && entry != fs::directory_iterator(); entry.increment(error)) {
    std::error_code unreadable;
    if (entry->is_directory(unreadable) && entry->path().filename().string().front() != '.') {
      folders.push_back(entry->path());
    }
  }
  std::sort(folders.begin(), folders.end());
  for (const fs::path& below : folders) {
    fs::path found = findPackage(below, name, depth - 1);
    if (!found.empty()) return found;
  }
  return {};
}

/// The folder of the package; "" when ROS_PACKAGE_PATH has none of that name.
fs::path packageFolder(const std::string& name) {
  const char* const variable = std::getenv("ROS_PACKAGE_PATH");
  std::istringstream entries(variable == nullptr ? "" : variable);
  for (std::string entry; std::getline(entries, entry, ':');) {
    if (entry.empty()) continue;
    // Fast path: most packages are in the folder of their name.
    fs::path direct = fs::path(entry) / name;
    std::error_code error;
    if (fs::exists(direct / "package.xml", error) && packageName(direct / "package.xml") == name) return direct;
    fs::path found = findPackage(entry, name, kSearchDepth);
    if (!found.empty()) return found;
  }
  return {};
}

/// Decodes percent escapes of a file:// URL.
std::string decodePercent(const std::string& text) {
  const auto digit = [](char c) {
    const std::size_t value = std::string("0123456789abcdefABCDEF").find(c);
    return value == std::string::npos ? -1 : static_cast<int>(value < 16 ? value : value - 6);
  };
  std::string decoded;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '%' && i + 2 < text.size() && digit(text[i + 1]) >= 0 && digit(text[i + 2]) >= 0) {
      decoded += static_cast<char>(16 * digit(text[i + 1]) + digit(text[i + 2]));
      i += 2;
    } else {
      decoded += text[i];
    }
  }
  return decoded;
}

/// Path of a file:// URL by RFC 8089: its host is none or localhost. "" otherwise; text: what is behind "file://".
std::string filePath(const std::string& text) {
  const std::size_t slash = text.find('/');
  if (slash == std::string::npos) return "";
  std::string host = text.substr(0, slash);
  std::transform(host.begin(), host.end(), host.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return host.empty() || host == "localhost" ? decodePercent(text.substr(slash)) : "";
}

}  // namespace

std::string resolveMeshUrl(const std::string& url) {
  const std::string file_scheme = "file://";
  const std::string package_scheme = "package://";
  if (startsWith(url, file_scheme)) return filePath(url.substr(file_scheme.size()));
  if (!startsWith(url, package_scheme)) {
    return url.find("://") == std::string::npos ? url : "";  // http:// and the like are not fetched
  }
  const std::string rest = url.substr(package_scheme.size());
  const std::size_t slash = rest.find('/');
  if (slash == 0 || slash == std::string::npos) return "";
  const fs::path folder = packageFolder(rest.substr(0, slash));
  return folder.empty() ? "" : (folder / rest.substr(slash + 1)).string();
}

}  // namespace curtain
