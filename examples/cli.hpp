// SPDX-License-Identifier: MIT
// A small reader of command lines: names, help, near misses; exit 0, 1 with `error: ...`, 2 on usage.
#pragma once

#include "tunica/core/parallel.hpp"

#include <algorithm>
#include <charconv>
#include <csignal>
#include <cstddef>
#include <cstdio>
#include <exception>
#include <functional>
#include <new>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>
#include <thread>
#include <type_traits>
#include <utility>
#include <vector>

namespace tunica::examples {

/// A command line that cannot be used.
struct UsageError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// A number that is the whole of a text.
template <class T>
requires std::is_arithmetic_v<T>
[[nodiscard]] T number_of(std::string_view text) {
  T value{};
  const auto r = std::from_chars(text.data(), text.data() + text.size(), value);
  if (r.ec != std::errc{} || r.ptr != text.data() + text.size() || text.empty())
    throw UsageError("\"" + std::string(text) + "\" is not a " +
                     (std::is_integral_v<T> ? "whole number" : "number"));
  return value;
}

/// The numbers of a text, between commas.
template <class T>
[[nodiscard]] std::vector<T> numbers_of(std::string_view text) {
  std::vector<T> values;
  for (;;) {
    const auto comma = text.find(',');
    values.push_back(number_of<T>(text.substr(0, comma)));
    if (comma == std::string_view::npos) return values;
    text.remove_prefix(comma + 1);
  }
}

class Cli {
 public:
  Cli(std::string program, std::string purpose)
      : program_(std::move(program)), purpose_(std::move(purpose)) {}

  using Take = std::function<void(const std::string&)>;

  /// An argument without a name; those that are required come first.
  void argument(const std::string& name, const std::string& help, std::string& value) {
    arguments_.push_back({name, help, true, [&value](const std::string& text) { value = text; }});
  }
  void optional_argument(const std::string& name, const std::string& help, std::string& value) {
    arguments_.push_back({name, help, false, [&value](const std::string& text) { value = text; }});
  }

  /// --name VALUE, at most once; take() reads the value and throws UsageError.
  void option(const std::string& name, const std::string& value, const std::string& help, Take take) {
    options_.push_back({name, value, help, false, false, std::move(take)});
  }
  /// --name VALUE, any number of times.
  void repeated(const std::string& name, const std::string& value, const std::string& help, Take take) {
    options_.push_back({name, value, help, true, false, std::move(take)});
  }
  /// --name alone.
  void flag(const std::string& name, const std::string& help, bool& set) {
    options_.push_back({name, "", help, false, false, [&set](const std::string&) { set = true; }});
  }
  void option(const std::string& name, const std::string& value, const std::string& help, std::string& to) {
    option(name, value, help, [&to](const std::string& text) { to = text; });
  }
  template <class T>
  requires std::is_arithmetic_v<T>
  void option(const std::string& name, const std::string& value, const std::string& help, T& to) {
    option(name, value, help, [&to](const std::string& text) { to = number_of<T>(text); });
  }
  template <class T>
  requires std::is_arithmetic_v<T>
  void option(const std::string& name, const std::string& value, const std::string& help,
              std::optional<T>& to) {
    option(name, value, help, [&to](const std::string& text) { to = number_of<T>(text); });
  }
  /// One of a few words, each with the value that it stands for.
  template <class T>
  void choice(const std::string& name, const std::string& help, std::vector<std::pair<std::string, T>> words,
              T& to) {
    std::string value;
    for (const auto& [word, meaning] : words) value += (value.empty() ? "" : "|") + word;
    option(name, value, help, [&to, words, value](const std::string& text) {
      for (const auto& [word, meaning] : words)
        if (word == text) {
          to = meaning;
          return;
        }
      throw UsageError("\"" + text + "\" is none of " + value);
    });
  }

  [[nodiscard]] std::string help() const {
    std::string text = "usage: " + program_;
    for (const auto& a : arguments_) text += a.required ? " " + a.name : " [" + a.name + "]";
    text += " [options]\n" + purpose_ + "\n\n";
    std::vector<std::pair<std::string, std::string>> rows;
    for (const auto& a : arguments_) rows.emplace_back(a.name, a.help);
    for (const auto& o : options_) rows.emplace_back(o.name + (o.value.empty() ? "" : " " + o.value), o.help);
    rows.emplace_back("--help", "this text");
    std::size_t width = 0;
    for (const auto& [left, right] : rows) width = std::max(width, std::min<std::size_t>(left.size(), 30));
    for (const auto& [left, right] : rows) {
      text += "  " + left;
      if (left.size() > width) text += "\n  " + std::string(width, ' ');
      text += std::string(width - std::min(width, left.size()), ' ') + "  ";
      for (const char c : right) text += c == '\n' ? "\n" + std::string(width + 4, ' ') : std::string(1, c);
      text += "\n";
    }
    return text + "\nExit: 0 done, 1 failed (error: ... on stderr), 2 wrong use.\n";
  }

  /// False when help was asked for. UsageError names the option and, if one is near, what was meant.
  [[nodiscard]] bool parse(const std::vector<std::string>& words) {
    std::size_t next = 0;
    for (std::size_t i = 0; i < words.size(); ++i) {
      const std::string& word = words[i];
      if (word == "--help" || word == "-h") return false;
      if (word.size() < 2 || word[0] != '-') {
        if (next == arguments_.size()) throw UsageError("unexpected argument \"" + word + "\"");
        arguments_[next++].take(word);
        continue;
      }
      const auto equal = word.find('=');
      const std::string name = word.substr(0, equal);
      const auto o =
          std::find_if(options_.begin(), options_.end(), [&](const Option& p) { return p.name == name; });
      if (o == options_.end()) throw UsageError("unknown option " + name + meant(name));
      if (o->given && !o->repeated) throw UsageError(name + " is given twice");
      o->given = true;
      std::string value;
      if (o->value.empty()) {
        if (equal != std::string::npos) throw UsageError(name + " takes no value");
      } else if (equal != std::string::npos) {
        value = word.substr(equal + 1);
      } else {
        if (i + 1 == words.size()) throw UsageError(name + " needs a value: " + o->value);
        value = words[++i];
      }
      try {
        o->take(value);
      } catch (const UsageError& e) {
        throw UsageError(name + ": " + e.what());
      }
    }
    if (next < arguments_.size() && arguments_[next].required)
      throw UsageError("no " + arguments_[next].name);
    return true;
  }

 private:
  struct Argument {
    std::string name, help;
    bool required;
    Take take;
  };
  struct Option {
    std::string name, value, help;
    bool repeated, given;
    Take take;
  };

  /// Number of letters to change, put in or leave out.
  [[nodiscard]] static std::size_t edits(std::string_view a, std::string_view b) {
    std::vector<std::size_t> row(b.size() + 1);
    for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
    for (std::size_t i = 1; i <= a.size(); ++i) {
      std::size_t diagonal = std::exchange(row[0], i);
      for (std::size_t j = 1; j <= b.size(); ++j) {
        const std::size_t up = row[j];
        row[j] = std::min({up + 1, row[j - 1] + 1, diagonal + (a[i - 1] != b[j - 1])});
        diagonal = up;
      }
    }
    return row.back();
  }

  [[nodiscard]] std::string meant(const std::string& name) const {
    std::string best = "--help";
    std::size_t least = edits(name, best);
    for (const auto& o : options_)
      if (const std::size_t e = edits(name, o.name); e < least) least = e, best = o.name;
    return least <= std::max<std::size_t>(1, name.size() / 3) ? "; did you mean " + best + "?" : "";
  }

  std::string program_, purpose_;
  std::vector<Argument> arguments_;
  std::vector<Option> options_;
};

inline void warn(const std::string& sentence) {
  std::fprintf(stderr, "warning: %s\n", sentence.c_str());
}

/// Reads the command line, runs the body and gives the exit status. All threads of the machine are
/// used; results do not depend on how many there are.
template <class Body>
[[nodiscard]] int run_program(Cli& cli, int argc, char** argv, Body&& body) {
  const auto fail = [](int status, const std::string& why) {
    std::fprintf(stderr, "error: %s\n", why.c_str());
    return status;
  };
  try {
    if (!cli.parse({argv + 1, argv + argc})) {
      std::fputs(cli.help().c_str(), stdout);
      return 0;
    }
    std::signal(SIGXFSZ, SIG_IGN);  // a file beyond the limit of its size is an error like a full disc
    thread_count() = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
    std::forward<Body>(body)();
    return 0;
  } catch (const UsageError& e) {
    return fail(2, std::string(e.what()) + " (--help tells more)");
  } catch (const std::bad_alloc&) {
    return fail(1, "not enough memory");
  } catch (const std::exception& e) {
    return fail(1, e.what());
  }
}

}  // namespace tunica::examples
