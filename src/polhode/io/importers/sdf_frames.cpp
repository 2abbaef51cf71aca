// SPDX-License-Identifier: Apache-2.0
#include <polhode/io/importers/sdf_frames.hpp>

#include <algorithm>

#include <polhode/core/format.hpp>
#include <polhode/core/names.hpp>

namespace polhode::io {

namespace {

/// Frames that are searched before the pose between two is taken by the world.
constexpr int kNear = 4;

}  // namespace

SdfFrames::SdfFrames(SdfFile& file) : file_(file) {
  SdfFrame world;
  world.kind = SdfFrame::Kind::world;
  world.at = &file.xml.root();
  world.name = "world";
  world.link = 0;
  frames_.push_back(std::move(world));
  scopes_.emplace_back();
  scopes_[0].names["world"] = 0;
}

int SdfFrames::add(SdfFrame frame, const std::string& local) {
  const int number = static_cast<int>(frames_.size());
  using Kind = SdfFrame::Kind;
  for (int s = frame.scope; s >= 0; s = scopes_[index(s)].above) {
    Scope& scope = scopes_[index(s)];
    if (frame.kind == Kind::link && scope.first_link < 0) scope.first_link = number;
    if (frame.kind == Kind::model && scope.first_model < 0) scope.first_model = number;
    if (local.empty() || scope.names.emplace(local, number).second) continue;
    // Before version 1.7 joints were no frames, and could be called as a link is.
    const bool joint =
        (frame.kind == Kind::joint) != (frames_[index(scope.names.at(local))].kind == Kind::joint);
    if (!joint)
      file_.xml.fault(*frame.at, format("the name {} stands twice", quote(frame.name)),
                      "Rename one of the two.");
    else if (frame.kind != Kind::joint)
      scope.names[local] = number;
    break;
  }
  frames_.push_back(std::move(frame));
  return number;
}

int SdfFrames::add_scope(int model, bool merged) {
  Scope scope;
  SdfFrame& frame = frames_[index(model)];
  scope.frame = model;
  scope.above = merged ? frame.scope : -1;
  scope.prefix = merged ? scopes_[index(frame.scope)].prefix : frame.name + "::";
  frame.inner = static_cast<int>(scopes_.size());
  scopes_.push_back(std::move(scope));
  return frame.inner;
}

int SdfFrames::find(int scope, const std::string& name) const {
  std::string_view rest = name;
  for (int s = scope; s >= 0;) {
    const Scope& here = scopes_[index(s)];
    if (rest == "__model__" && s > 0) return here.frame;
    if (const auto found = here.names.find(std::string(rest)); found != here.names.end())
      return found->second;
    const std::size_t end = rest.find("::");
    const auto model = end == std::string_view::npos
                           ? here.names.end()
                           : here.names.find(std::string(rest.substr(0, end)));
    if (model != here.names.end() && frames_[index(model->second)].inner >= 0) {
      s = frames_[index(model->second)].inner;
      rest.remove_prefix(end + 2);
    } else {
      s = here.above;
    }
  }
  return -1;
}

int SdfFrames::required(const XmlFile::Element& at, int scope, const std::string& name) {
  const int found = find(scope, name);
  if (found >= 0) return found;
  std::vector<std::string> names;
  for (const auto& [known, frame] : scopes_[index(scope)].names) names.push_back(known);
  std::sort(names.begin(), names.end());
  file_.xml.fault(at, format("there is no link or frame {}", quote(name)),
                  did_you_mean(name, names) + "Frames: " + name_list(names, 12) + ".");
  return -1;
}

void SdfFrames::connect() {
  base_.assign(frames_.size(), -1);
  for (std::size_t i = 1; i < frames_.size(); ++i) base_[i] = base_of(static_cast<int>(i));
  local_.resize(frames_.size());
  world_.resize(frames_.size());
  local_state_.assign(frames_.size(), State::open);
  world_state_.assign(frames_.size(), State::open);
  world_state_[0] = local_state_[0] = State::known;
  for (std::size_t i = 1; i < frames_.size(); ++i) static_cast<void>(in_world(static_cast<int>(i)));
}

int SdfFrames::base_of(int frame) {
  const SdfFrame& f = (*this)[frame];
  if (!f.pose.relative_to.empty()) return required(*f.at, f.scope, f.pose.relative_to);
  if (!f.attached_to.empty() && f.kind != SdfFrame::Kind::model) {
    // A joint in the world's frame, of which nothing is relative to its child.
    if (f.kind == SdfFrame::Kind::joint && f.attached_to == "world") return 0;
    return required(*f.at, f.scope, f.attached_to);
  }
  return model_frame(f.scope);
}

int SdfFrames::link_of(const XmlFile::Element& at, int frame) {
  using Kind = SdfFrame::Kind;
  for (std::size_t steps = 0; frame >= 0 && steps <= frames_.size(); ++steps) {
    const SdfFrame& f = (*this)[frame];
    if (f.kind == Kind::link || f.kind == Kind::world) return frame;
    if (f.kind == Kind::model) {
      const Scope& inside = scopes_[index(f.inner)];
      if (!f.attached_to.empty())
        frame = required(*f.at, f.inner, f.attached_to);
      else
        frame = inside.first_link >= 0 ? inside.first_link : inside.first_model;
      if (frame < 0) {
        file_.xml.fault(at, format("the model {} has no link", quote(f.name)),
                        "Name a frame that is on a link.");
        return -1;
      }
    } else {
      frame =
          f.attached_to.empty() ? model_frame(f.scope) : required(*f.at, f.scope, f.attached_to);
    }
  }
  if (frame >= 0)
    file_.xml.fault(at, format("the frame {} is attached to itself", quote((*this)[frame].name)),
                    "Attach one of the frames to a link.");
  return -1;
}

/// Pose of a frame in the model that contains it; nothing if it is not relative to the model.
std::optional<Pose> SdfFrames::within(int frame, int model) {
  Pose pose;
  for (std::size_t steps = 0; frame != model; ++steps) {
    if (frame <= 0 || steps > frames_.size()) return std::nullopt;
    pose = local(frame) * pose;
    frame = base_[index(frame)];
  }
  return pose;
}

const Pose& SdfFrames::local(int frame) {
  Pose& pose = local_[index(frame)];
  State& state = local_state_[index(frame)];
  if (state == State::known) return pose;
  const SdfFrame& f = (*this)[frame];
  pose = f.pose.pose;
  const bool again = state == State::busy;
  state = State::busy;
  if (!f.placement.empty() && !again) {
    const int placed = required(*f.at, f.inner, f.placement);
    const auto inside = placed < 0 ? std::nullopt : within(placed, frame);
    if (inside)
      pose = f.pose.pose * inside->inverse();
    else if (placed >= 0)
      file_.xml.fault(*f.at, format("the placement frame of {} is not in it", quote(f.name)),
                      "Name a frame of the model.");
  }
  state = State::known;
  return pose;
}

const Pose& SdfFrames::in_world(int frame) {
  std::vector<int> way;
  for (int i = frame; world_state_[index(i)] != State::known; i = base_[index(i)]) {
    if (world_state_[index(i)] == State::busy) {
      file_.xml.fault(*(*this)[i].at,
                      format("the pose of {} is relative to itself", quote((*this)[i].name)),
                      "Let one of the poses be relative to the model.");
      break;
    }
    world_state_[index(i)] = State::busy;
    way.push_back(i);
    if (base_[index(i)] < 0) break;  // After an error.
  }
  for (auto i = way.rbegin(); i != way.rend(); ++i) {
    const int base = base_[index(*i)];
    world_[index(*i)] = base < 0 ? local(*i) : world_[index(base)] * local(*i);
    world_state_[index(*i)] = State::known;
  }
  return world_[index(frame)];
}

Pose SdfFrames::between(int a, int b) {
  const auto below = [&](int upper, int lower) -> std::optional<Pose> {
    Pose pose;
    for (int k = 0; k <= kNear && lower >= 0; ++k) {
      if (lower == upper) return pose;
      pose = k == 0 ? local(lower) : local(lower) * pose;
      lower = base_[index(lower)];
    }
    return std::nullopt;
  };
  // Poses as they are written, without rounding, where one frame is relative to the other.
  if (const auto pose = below(a, b)) return *pose;
  if (const auto pose = below(b, a)) return pose->inverse();
  return in_world(a).inverse() * in_world(b);
}

}  // namespace polhode::io
