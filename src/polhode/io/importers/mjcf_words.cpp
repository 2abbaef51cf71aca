// SPDX-License-Identifier: Apache-2.0
#include <string_view>
#include <utility>

#include <polhode/core/format.hpp>
#include <polhode/io/importers/mjcf_file.hpp>

namespace polhode::io {

namespace {

/// Attributes that MuJoCo 4.0 reads in a tag, which stands alone or after the tag around it. The
/// common ones of all actuators or sensors are under these words.
constexpr std::pair<std::string_view, std::string_view> kWords[] = {
    {"joint",
     "actuatorfrclimited actuatorfrcrange actuatorgravcomp armature axis class "
     "damping frictionloss group limited margin name pos range ref "
     "solimpfriction solimplimit solreffriction solreflimit springdamper "
     "springref springyield stiffness type user"},
    {"geom",
     "adhesion axisangle castshadow class conaffinity condim contype density "
     "euler fitscale fluidcoef fluidshape friction fromto gap group hfield "
     "margin mass material mesh name pos priority quat rgba shellinertia size "
     "solimp solmix solref surfacevel type user xyaxes zaxis"},
    {"site",
     "axisangle class euler fromto group material mesh name pos quat rgba size "
     "type user xyaxes zaxis"},
    {"camera",
     "axisangle class euler focal focalpixel fovy ipd mode name output pos "
     "principal principalpixel projection quat resolution sensorsize target user "
     "xyaxes zaxis"},
    {"light",
     "active ambient attenuation bulbradius castshadow class cutoff diffuse dir "
     "directional exponent intensity mode name pos range softness specular "
     "target texture type"},
    {"mesh",
     "builtin class content_type face file inertia material maxhullvert name "
     "normal params refpos refquat scale smoothnormal texcoord vertex"},
    {"material",
     "class emission metallic name reflectance rgba roughness shininess specular "
     "texrepeat texture texuniform"},
    {"texture",
     "builtin class colorspace content_type embed file fileback filedown "
     "filefront fileleft fileright fileup gridlayout gridsize height hflip mark "
     "markrgb name nchannel random rgb1 rgb2 type vflip width"},
    {"hfield", "content_type elevation file name ncol nrow size"},
    {"skin", "face file group inflate material name rgba texcoord vertex"},
    {"model", "content_type file name"},
    {"pair",
     "adhesion class condim friction gap geom1 geom2 margin name solimp solref "
     "solreffriction"},
    {"exclude", "body1 body2 name"},
    {"equality", "active solimp solref"},
    {"tendon",
     "actuatorfrclimited actuatorfrcrange armature damping frictionloss group "
     "limited margin material range rgba solimpfriction solimplimit "
     "solreffriction solreflimit springlength springyield stiffness user width"},
    {"spatial",
     "actuatorfrclimited actuatorfrcrange armature class damping frictionloss "
     "group limited margin material name range rgba solimpfriction solimplimit "
     "solreffriction solreflimit springlength springyield stiffness user width"},
    {"fixed",
     "actuatorfrclimited actuatorfrcrange armature class damping frictionloss "
     "group limited margin name range solimpfriction solimplimit solreffriction "
     "solreflimit springlength springyield stiffness user"},
    {"spatial/site", "site"},
    {"spatial/geom", "geom sidesite"},
    {"spatial/pulley", "divisor"},
    {"fixed/joint", "coef joint"},
    {"equality/connect", "active anchor body1 body2 class name site1 site2 solimp solref"},
    {"equality/weld",
     "active anchor body1 body2 class name relpose site1 site2 solimp solref "
     "torquescale"},
    {"equality/joint", "active class joint1 joint2 name polycoef solimp solref"},
    {"equality/tendon", "active class name polycoef solimp solref tendon1 tendon2"},
    {"equality/flex", "active class flex name solimp solref"},
    {"equality/flexstrain", "active cell class flex name solimp solref"},
    {"actuator/general",
     "actdim actearly actlimited actrange biasprm biastype body dynprm dyntype "
     "ffrange gainprm gaintype inheritrange input velrange"},
    {"actuator/motor", ""},
    {"actuator/position", "dampratio inheritrange kp kv timeconst"},
    {"actuator/velocity", "kv"},
    {"actuator/intvelocity", "actlimited actrange dampratio inheritrange kp kv"},
    {"actuator/orientation", "dampratio input kp kv"},
    {"actuator/pid",
     "dampratio ffrange imax inheritrange input ki kp kv posrange slewmax "
     "velrange"},
    {"actuator/damper", "kv"},
    {"actuator/cylinder", "area bias diameter timeconst"},
    {"actuator/muscle", "force fpmax fvmax lmax lmin range scale tausmooth timeconst vmax"},
    {"actuator/adhesion", "body gain"},
    {"actuator/dcmotor",
     "cogging controller inductance input lugre motorconst nominal resistance "
     "saturation thermal"},
    {"actuator/plugin", "actdim actearly actlimited actrange dynprm dyntype instance plugin"},
    {"sensor",
     "actuator body body1 body2 camera cutoff data datatype delay dim enclosed "
     "geom geom1 geom2 instance interp interval joint mesh name needstage noise "
     "nsample num objname objtype plugin reduce refname reftype site subtree1 "
     "subtree2 tendon user"},
    {"actuator",
     "armature class cranklength cranksite ctrllimited ctrlrange damping delay "
     "forcelimited forcerange gear group interp joint jointinparent lengthrange "
     "name nsample refsite site slidersite tendon user"},
};

/// Attributes of an entry; null if there is none.
const std::string_view* words_of(std::string_view key) {
  for (const auto& entry : kWords)
    if (entry.first == key) return &entry.second;
  return nullptr;
}

bool contains_word(std::string_view words, std::string_view word) {
  for (std::size_t at = words.find(word); at != std::string_view::npos;
       at = words.find(word, at + 1)) {
    const std::size_t end = at + word.size();
    if ((at == 0 || words[at - 1] == ' ') && (end == words.size() || words[end] == ' '))
      return true;
  }
  return false;
}

/// Tags whose content is known as a whole.
bool is_closed(std::string_view tag) {
  return tag == "default" || tag == "asset" || tag == "contact" || tag == "spatial" ||
         tag == "fixed";
}

void list_unknown(const XmlFile::Element& e, IgnoredTags& ignored) {
  const XmlFile::Element* above = e.Parent() == nullptr ? nullptr : e.Parent()->ToElement();
  const std::string around = above == nullptr ? "" : above->Name();
  const std::string tag = e.Name();
  const bool actuator = words_of("actuator/" + tag) != nullptr &&
                        (around == "actuator" || (around == "default" && words_of(tag) == nullptr));
  const bool sensor = around == "sensor";
  const std::string_view* words = actuator ? words_of("actuator/" + tag)
                                  : sensor ? words_of("sensor")
                                           : words_of(around + "/" + tag);
  if (words == nullptr) words = words_of(tag);
  if (words == nullptr) {
    if (is_closed(around)) ignored.add(e, format("<{}> in <{}>", tag, around), "is unknown");
    return;
  }
  for (const tinyxml2::XMLAttribute* a = e.FirstAttribute(); a != nullptr; a = a->Next())
    if (!contains_word(*words, a->Name()) &&
        !(actuator && contains_word(*words_of("actuator"), a->Name())))
      ignored.add(e, format("attribute '{}' of <{}>", a->Name(), tag), "is unknown");
  for (const XmlFile::Element* inner = e.FirstChildElement(); inner != nullptr;
       inner = inner->NextSiblingElement())
    list_unknown(*inner, ignored);
}

}  // namespace

void MjcfFile::skip(const Element& e) {
  list_unknown(e, ignored);
  xml.skip(e);
}

}  // namespace polhode::io
