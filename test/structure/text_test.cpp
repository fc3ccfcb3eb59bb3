// SPDX-License-Identifier: BSD-3-Clause
//
// What holds for the text of the checkout: sources name their licence in the first line, and no file holds the address
// of a package registry or a note of work left over.
#include <gtest/gtest.h>

#include <cctype>

#include "structure/source_files.h"

namespace {

using curtain_test::lines;
using curtain_test::SourceFile;
using curtain_test::sourceFiles;

TEST(Text, SourcesBeginWithTheirLicence) {
  int checked = 0;
  for (const char* folder : {"src", "include"}) {
    for (const SourceFile& file : sourceFiles(folder)) {
      const auto text = lines(file.text);
      ASSERT_FALSE(text.empty()) << file.name;
      const bool python = file.name.find(".py") != std::string::npos || file.name == "src/python/py.typed";
      EXPECT_EQ(text[0], std::string(python ? "#" : "//") + " SPDX-License-Identifier: BSD-3-Clause") << file.name;
      ++checked;
    }
  }
  EXPECT_GT(checked, 50);
}

// Text files of the checkout, this one aside: it spells what it looks for.
std::vector<SourceFile> textFiles() {
  std::vector<SourceFile> files;
  for (SourceFile& file : sourceFiles("")) {
    const bool binary = file.text.find('\0') != std::string::npos;
    if (!binary && file.name != "test/structure/text_test.cpp") files.push_back(std::move(file));
  }
  return files;
}

bool hasWord(const std::string& line, const std::string& word) {
  const auto letter = [&](std::size_t at) {
    return at < line.size() && (std::isalnum(static_cast<unsigned char>(line[at])) != 0 || line[at] == '_');
  };
  for (std::size_t at = line.find(word); at != std::string::npos; at = line.find(word, at + 1)) {
    if ((at == 0 || !letter(at - 1)) && !letter(at + word.size())) return true;
  }
  return false;
}

// What is typed twice is one day typed wrong once.
TEST(Text, ConstantsOfNatureStandInOneFile) {
  for (const char* digits : {"3.14159", "M_PI", "1099511628211"}) {  // pi, and the prime of FNV-1a
    int files = 0;
    for (const char* folder : {"src", "include"}) {
      for (const SourceFile& file : sourceFiles(folder)) files += file.text.find(digits) != std::string::npos ? 1 : 0;
    }
    EXPECT_LE(files, 1) << digits;
  }
}

TEST(Text, HasNoNotesOfWorkLeftOver) {
  const auto files = textFiles();
  EXPECT_GT(files.size(), 100u);
  for (const SourceFile& file : files) {
    int number = 0;
    for (const std::string& line : lines(file.text)) {
      ++number;
      for (const char* word : {"FIXME", "TODO"}) EXPECT_FALSE(hasWord(line, word)) << file.name << ":" << number;
    }
  }
}

TEST(Text, HasNoRegistryAddresses) {
  // Hosts of package registries and mirrors, and the options that point a client at one.
  const char* const addresses[] = {
      "pypi.org",         "pythonhosted.org",   "registry.npmjs",   "registry.yarnpkg",    "crates.io",
      "proxy.golang.org", "sum.golang.org",     "rubygems.org",     "anaconda.org",        "repo.maven",
      "deb.debian.org",   "archive.ubuntu.com", "ports.ubuntu.com", "security.ubuntu.com", "packages.ros.org",
      "docker.io/",       "ghcr.io/",           "quay.io/",         "artifactory",         "/simple/",
      "--index-url",      "extra-index-url"};
  for (const SourceFile& file : textFiles()) {
    int number = 0;
    for (const std::string& line : lines(file.text)) {
      ++number;
      for (const char* address : addresses) {
        EXPECT_EQ(line.find(address), std::string::npos) << file.name << ":" << number << " names " << address;
      }
    }
  }
}

}  // namespace
