// All structs with fields, by their tables in docs/reference.
#pragma once

#include "scene/fields/body_fields.h"
#include "scene/fields/camera_fields.h"
#include "scene/fields/force_fields.h"
#include "scene/fields/joint_fields.h"
#include "scene/fields/label_fields.h"
#include "scene/fields/many_bodies_fields.h"
#include "scene/fields/overlay_fields.h"
#include "scene/fields/settings_fields.h"
#include "scene/fields/water_fields.h"

namespace tumble {

/// Calls `use.operator()<Struct>(table)` for each.
void for_all_fields(auto&& use) {
    use.template operator()<SimulationSettings>("simulation");
    use.template operator()<OutputSettings>("output");
    use.template operator()<CameraDescription>("camera");
    use.template operator()<DepthOfField>("dof");
    use.template operator()<CameraKeyframe>("camera keyframe");
    use.template operator()<CameraShot>("shot");
    use.template operator()<CameraInset>("inset");
    use.template operator()<LightDescription>("light");
    use.template operator()<LampDescription>("one of several lights");
    use.template operator()<EnvironmentDescription>("environment");
    use.template operator()<WindDescription>("wind");
    use.template operator()<PairRules>("contact");
    use.template operator()<Material>("material");
    use.template operator()<BodyDescription>("body");
    use.template operator()<FractureRequest>("fracture");
    use.template operator()<FractureMaterial>("fracture material");
    use.template operator()<Keyframe>("body keyframe");
    use.template operator()<CompoundPart>("part");
    use.template operator()<GridRequest>("grid");
    use.template operator()<ScatterRequest>("scatter");
    use.template operator()<CopyLooks>("copies");
    use.template operator()<PoseRow>("poses");
    use.template operator()<ChainRequest>("chain");
    use.template operator()<TemplateRequest>("template");
    use.template operator()<TemplateFile>("template file");
    use.template operator()<InstanceRequest>("instance");
    use.template operator()<ForceDescription>("force");
    use.template operator()<FieldDescription>("field");
    use.template operator()<FieldRegion>("field region");
    use.template operator()<PairForceDescription>("pair force");
    use.template operator()<ExplosionDescription>("explosion");
    use.template operator()<WaterDescription>("water");
    use.template operator()<WaterWave>("wave");
    use.template operator()<CordDescription>("cord");
    use.template operator()<SpeedKeyframe>("speed");
    use.template operator()<OverlayDescription>("overlay");
    use.template operator()<TrailPoint>("trail point");
    use.template operator()<Caption>("caption");
    use.template operator()<LabelDescription>("label");
    use.template operator()<LogoDescription>("logo");
    use.template operator()<JointDescription>("joint");
    use.template operator()<JointAxis>("joint coordinate");
    use.template operator()<JointSpring>("spring");
    use.template operator()<JointMotor>("motor");
    use.template operator()<JointTarget>("motor keyframe");
}

}  // namespace tumble
