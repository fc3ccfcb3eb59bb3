// SPDX-License-Identifier: BSD-3-Clause
#include "scene/yaml_text.h"

#include <yaml-cpp/eventhandler.h>

#include <map>
#include <sstream>
#include <string_view>
#include <utility>
#include <vector>

namespace curtain {
namespace {

std::string placed(const YAML::Mark& mark, const std::string& text) {
  return "line " + std::to_string(mark.line + 1) + ", column " + std::to_string(mark.column + 1) + ": " + text;
}

struct Refusal {
  std::string text;
};

// Bytes of the UTF-8 character that text begins with; 0: there is none (RFC 3629, Sect. 4).
std::size_t characterLength(std::string_view text) {
  const auto byte = [&](std::size_t k) { return k < text.size() ? static_cast<unsigned char>(text[k]) : 0U; };
  const unsigned first = byte(0), second = byte(1);
  const auto follows = [&](std::size_t k) { return byte(k) >= 0x80 && byte(k) <= 0xBF; };
  if (first <= 0x7F) return 1;
  if (first >= 0xC2 && first <= 0xDF) return follows(1) ? 2 : 0;
  if (first >= 0xE0 && first <= 0xEF) {
    const bool fits = !(first == 0xE0 && second < 0xA0) && !(first == 0xED && second > 0x9F);
    return fits && follows(1) && follows(2) ? 3 : 0;
  }
  if (first >= 0xF0 && first <= 0xF4) {
    const bool fits = !(first == 0xF0 && second < 0x90) && !(first == 0xF4 && second > 0x8F);
    return fits && follows(1) && follows(2) && follows(3) ? 4 : 0;
  }
  return 0;
}

// yaml-cpp takes any bytes; 0.6 allocates without end on some that are no characters.
void requireUtf8(const std::string& text) {
  YAML::Mark mark;
  for (std::size_t at = 0, length = 0; at < text.size(); at += length) {
    length = characterLength(std::string_view(text).substr(at));
    if (length == 0) throw Refusal{placed(mark, "not UTF-8 text")};
    ++mark.column;
    if (text[at] == '\n') ++mark.line, mark.column = 0;
  }
}

// Counts documents and values without building a tree.
class Inspector final : public YAML::EventHandler {
 public:
  std::size_t documents() const { return documents_; }

  void OnDocumentStart(const YAML::Mark& mark) override {
    // Parsing has not advanced: without this check it would find empty documents for ever.
    if (documents_ > 0 && mark.pos <= last_start_) throw Refusal{placed(mark, "not YAML: nothing can begin here")};
    last_start_ = mark.pos;
    ++documents_;
    sizes_.clear();
  }
  void OnDocumentEnd() override {}

  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override { countOne(mark, anchor); }
  void OnScalar(const YAML::Mark& mark, const std::string&, YAML::anchor_t anchor, const std::string&) override {
    countOne(mark, anchor);
  }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    const auto size = sizes_.find(anchor);
    if (size == sizes_.end()) throw Refusal{placed(mark, "not YAML: an alias within what it stands for")};
    count(mark, size->second);
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value) override {
    open(mark, anchor);
  }
  void OnSequenceEnd() override { close(); }
  void OnMapStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value) override {
    open(mark, anchor);
  }
  void OnMapEnd() override { close(); }

 private:
  void count(const YAML::Mark& mark, std::size_t more) {
    values_ += more;
    if (values_ <= kMaxYamlValues) return;
    throw Refusal{
        placed(mark, "comes to more than " + std::to_string(kMaxYamlValues) + " values, which no scene needs")};
  }
  void countOne(const YAML::Mark& mark, YAML::anchor_t anchor) {
    count(mark, 1);
    if (anchor != 0) sizes_[anchor] = 1;
  }
  void open(const YAML::Mark& mark, YAML::anchor_t anchor) {
    open_.emplace_back(anchor, values_);
    count(mark, 1);
  }
  void close() {
    const auto [anchor, before] = open_.back();
    open_.pop_back();
    if (anchor != 0) sizes_[anchor] = values_ - before;
  }

  std::size_t documents_ = 0;
  int last_start_ = 0;
  std::size_t values_ = 0;
  std::vector<std::pair<YAML::anchor_t, std::size_t>> open_;  // with the number of values before
  std::map<YAML::anchor_t, std::size_t> sizes_;               // values that an anchor stands for
};

}  // namespace

bool loadYaml(const std::string& text, YAML::Node& root, std::string& problem) {
  try {
    if (text.size() > kLongestYaml) throw Refusal{"is longer than 16 MiB, which no scene needs"};
    requireUtf8(text);
    Inspector inspector;
    std::istringstream stream(text);
    YAML::Parser parser(stream);
    while (parser.HandleNextDocument(inspector)) {
    }
    if (inspector.documents() > 1) {
      throw Refusal{"must be one YAML document, is " + std::to_string(inspector.documents()) + " (split by ---)"};
    }
    root = inspector.documents() == 0 ? YAML::Node() : YAML::Load(text);
    return true;
  } catch (const YAML::Exception& error) {
    problem = placed(error.mark, "not YAML: " + error.msg);
  } catch (const Refusal& refusal) {
    problem = refusal.text;
  }
  return false;
}

}  // namespace curtain
