// SPDX-License-Identifier: Apache-2.0
#include <polhode/core/format.hpp>
#include <polhode/io/importers/feb_model.hpp>

namespace polhode::io {

namespace {

using Element = XmlFile::Element;

/// Steps of a file; more are an error of it.
constexpr std::size_t kMostFileSteps = 1000;

std::size_t size_of(const SourceNode& map) { return map.keys.size(); }

void add_new(const SourceNode& map, std::size_t from, std::vector<std::string>& items) {
  for (std::size_t k = from; k < map.keys.size(); ++k) items.push_back(map.keys[k].name);
}

}  // namespace

bool read_feb_steps(FebModel& model) {
  FebFile& file = model.file;
  const Element& root = file.xml.root();
  std::vector<const Element*> list;
  if (const Element* steps = file.xml.child(root, "Step")) list = file.xml.children(*steps, "step");
  for (const Element* e : list) file.ignored.attributes(*e, {"id", "name"});
  if (list.size() > kMostFileSteps) {
    file.xml.fault(*list[kMostFileSteps], format("the file has {} steps", list.size()),
                   format("Give at most {}.", kMostFileSteps));
    list.resize(kMostFileSteps);
  }
  if (list.empty()) list.push_back(&root);
  const Element* shared = file.child(root, "Control");
  for (const Element* e : list) {
    const Element* own = e == &root ? nullptr : file.child(*e, "Control");
    if (own != nullptr && shared != nullptr && list.size() == 1)
      file.xml.fault(*own, "<Control> stands twice", "Keep one of them.");
    const Element* control = own != nullptr ? own : shared;
    if (control == nullptr) {
      file.xml.fault(*e, e == &root ? "the file has no <Control>" : "the step has no <Control>",
                     "Add it, in the file or in each step.");
      return false;
    }
    model.steps.push_back({e, control, 0.0, 0.0, {}, {}});
  }
  read_feb_control(model);
  return true;
}

void FebModel::each_section(const char* name, FebIn in,
                            const std::function<void(const Element&)>& read) {
  const Element& root = file.xml.root();
  for (const Element* e : file.xml.children(root, name)) read(*e);
  for (FebStep& s : steps) {
    if (s.at == &root) continue;
    const bool several = steps.size() > 1;
    for (const Element* e : file.xml.children(*s.at, name)) {
      if (several && (in == FebIn::file || (in == FebIn::start && &s != &steps.front()))) {
        if (e->FirstChildElement() != nullptr)
          file.refuse(*e, format("<{}> of one step of several is not read", name),
                      "Put it outside the steps, with load curves over all of them.");
        continue;
      }
      step = several ? &s : nullptr;
      if (several && in == FebIn::values) {
        // Loads on solids cannot be switched; their values are zero in other steps.
        curves.window = FebWindow{s.begin, &s == &steps.back() ? 2.0 * s.end : s.end};
      }
      const std::size_t first_joint = size_of(joints), first_load = size_of(loads);
      read(*e);
      curves.window.reset();
      if (step != nullptr && in == FebIn::step) {
        add_new(joints, first_joint, s.items);
        add_new(loads, first_load, s.items);
        s.items.insert(s.items.end(), switched.begin(), switched.end());
      }
      switched.clear();
      step = nullptr;
    }
  }
}

void write_feb_steps(FebModel& model, SourceNode& root) {
  const NodeBuilder make = model.file.make(*model.steps.front().at);
  const auto put = [&](SourceNode& event, const char* key, const std::vector<std::string>& items) {
    SourceNode list = make.list();
    for (const std::string& item : items) list.children.push_back(make.text(item));
    if (!items.empty()) make.put(event, key, std::move(list));
  };
  SourceNode events = make.map();
  for (std::size_t k = 0; k < model.steps.size(); ++k) {
    std::vector<std::string> off;
    if (k > 0) off = model.steps[k - 1].items;
    off.insert(off.end(), model.steps[k].ended.begin(), model.steps[k].ended.end());
    for (std::size_t j = 1; k == 0 && j < model.steps.size(); ++j)
      off.insert(off.end(), model.steps[j].items.begin(), model.steps[j].items.end());
    SourceNode event = make.map();
    make.put(event, "at", make.number(model.steps[k].begin));
    put(event, "off", off);
    if (k > 0) put(event, "on", model.steps[k].items);
    if (event.keys.size() > 1) make.put(events, format("step{}", k + 1), std::move(event));
  }
  if (!events.keys.empty()) make.put(root, "events", std::move(events));
}

}  // namespace polhode::io
