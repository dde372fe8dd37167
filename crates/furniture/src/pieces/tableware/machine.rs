//! Small machines that stand on a worktop, class other prop: kettles, toasters, coffee machines, blenders, scales, microwave ovens and
//! stand mixers. Each has a fixed size; the finish of its body varies. Fronts face +y.

use crate::builder::{Builder, Class, Object};
use crate::materials::Finish;
use crate::pieces::form::{all, cylinder, loft, picture, rod, to_front, turned, vessel, wire};
use crate::pieces::{CONTACT, Furniture, board, on};
use crate::shape::{Reshape, rounded_box};
use enfilade_math::{DAffine3, Rng, Vec3};
use std::f32::consts::FRAC_PI_2;

/// Small machines that stand on a worktop; their fronts face +y.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs, reason = "plain words")]
pub enum KitchenMachine {
    Kettle,
    Toaster,
    CoffeeMachine,
    Blender,
    Scales,
    Microwave,
    StandMixer,
}

impl Furniture for KitchenMachine {
    fn random(rng: &mut Rng) -> Self {
        let kinds = [Self::Kettle, Self::Toaster, Self::CoffeeMachine, Self::Blender, Self::Scales, Self::Microwave, Self::StandMixer];
        kinds[rng.below(kinds.len())]
    }

    fn size(&self) -> Vec3 {
        Vec3::from_array(match self {
            Self::Kettle => [0.245, 0.17, 0.25],
            Self::Toaster => [0.33, 0.18, 0.21],
            Self::CoffeeMachine => [0.26, 0.38, 0.355],
            Self::Blender => [0.22, 0.18, 0.40],
            Self::Scales => [0.16, 0.22, 0.02],
            Self::Microwave => [0.47, 0.43, 0.28],
            Self::StandMixer => [0.2, 0.36, 0.35],
        })
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let name = match self {
            Self::Kettle => "kettle",
            Self::Toaster => "toaster",
            Self::CoffeeMachine => "coffee_machine",
            Self::Blender => "blender",
            Self::Scales => "scales",
            Self::Microwave => "microwave",
            Self::StandMixer => "stand_mixer",
        };
        // A coffee machine is further back, since its handle protrudes far to the front.
        let back = if *self == Self::CoffeeMachine { -0.025 } else { 0.0 };
        let object = b.object(name, Class::OtherProp, on(pose, Vec3::new(0.0, back, CONTACT), 0.0));
        let body = [Finish::Steel, Finish::BlackPlastic, Finish::CoatedWhite, Finish::ColoredMetal(rng.below(3) as u8)][rng.below(4)];
        match self {
            Self::Kettle => kettle(b, &object, body),
            Self::Toaster => toaster(b, &object, body),
            Self::CoffeeMachine => coffee_machine(b, &object, body),
            Self::Blender => blender(b, &object, body),
            Self::Scales => scales(b, &object),
            Self::Microwave => microwave(b, &object, body),
            Self::StandMixer => stand_mixer(b, &object, body),
        }
    }
}

fn kettle(b: &mut Builder, kettle: &Object, body: Finish) {
    b.part(kettle, "base", cylinder(0.078, 0.018, 40), Finish::BlackPlastic);
    let can = [
        [0.0, 0.019],
        [0.074, 0.019],
        [0.076, 0.024],
        [0.073, 0.08],
        [0.062, 0.165],
        [0.055, 0.205],
        [0.048, 0.215],
        [0.02, 0.221],
        [0.0, 0.222],
    ];
    b.part(kettle, "can", turned(&can, 48), body);
    b.part(
        kettle,
        "knob",
        turned(&[[0.0, 0.2215], [0.012, 0.2215], [0.014, 0.232], [0.010, 0.238], [0.0, 0.239]], 24),
        Finish::BlackPlastic,
    );
    let spout = loft(&[[0.05, 0.04, 0.012, 0.0], [0.03, 0.028, 0.01, 0.035], [0.026, 0.025, 0.01, 0.036]], 4);
    b.part(kettle, "spout", spout.turned(Vec3::Y, -0.9).moved(Vec3::new(-0.052, 0.0, 0.172)), body);
    let grip = wire(&[[0.052, 0.0, 0.2], [0.095, 0.0, 0.205], [0.108, 0.0, 0.17], [0.104, 0.0, 0.09], [0.074, 0.0, 0.055]], 0.0095, 12);
    b.part(kettle, "grip", grip, Finish::BlackPlastic);
}

fn toaster(b: &mut Builder, toaster: &Object, body: Finish) {
    let shell = rounded_box(Vec3::new(0.28, 0.165, 0.18), 0.035, 5).moved(Vec3::new(0.0, 0.0, 0.105));
    b.part(toaster, "shell", shell, body);
    b.part(toaster, "foot", board([-0.13, -0.072, 0.0], [0.13, 0.072, 0.03], 0.004), Finish::BlackPlastic);
    for (i, y) in [-0.032, 0.032].into_iter().enumerate() {
        let slot = board([-0.105, y - 0.016, 0.1935], [0.105, y + 0.016, 0.1962], 0.001);
        b.part(toaster, &format!("rim_{}", i + 1), slot, Finish::Steel);
        b.part(toaster, &format!("slot_{}", i + 1), board([-0.10, y - 0.012, 0.19], [0.10, y + 0.012, 0.1966], 0.0005), Finish::Soil);
    }
    let lever = board([0.138, -0.018, 0.13], [0.162, 0.018, 0.148], 0.004);
    let dial = cylinder(0.016, 0.012, 24).turned(Vec3::Y, FRAC_PI_2).moved(Vec3::new(0.139, 0.0, 0.065));
    b.part(toaster, "lever", lever.with(dial), Finish::BlackPlastic);
}

fn coffee_machine(b: &mut Builder, machine: &Object, body: Finish) {
    b.part(machine, "back", rounded_box(Vec3::new(0.25, 0.17, 0.33), 0.008, 2).moved(Vec3::new(0.0, -0.07, 0.165)), body);
    b.part(machine, "head", rounded_box(Vec3::new(0.25, 0.16, 0.13), 0.008, 2).moved(Vec3::new(0.0, 0.065, 0.265)), body);
    b.part(machine, "tray", board([-0.12, 0.015, 0.0], [0.12, 0.15, 0.04], 0.004), Finish::BlackPlastic);
    let grid = all((0..9).map(|k| board([-0.11, 0.028 + 0.0135 * k as f32, 0.0398], [0.11, 0.034 + 0.0135 * k as f32, 0.0425], 0.0008)));
    b.part(machine, "grid", grid, Finish::Chrome);
    b.part(machine, "group", cylinder(0.034, 0.035, 32).moved(Vec3::new(0.0, 0.075, 0.167)), Finish::Chrome);
    b.part(machine, "portafilter", cylinder(0.031, 0.022, 32).moved(Vec3::new(0.0, 0.075, 0.1448)), Finish::Chrome);
    b.part(machine, "handle", rod([0.0, 0.1, 0.155], [0.0, 0.2, 0.145], 0.0105, 14), Finish::BlackPlastic);
    b.part(machine, "steam_pipe", wire(&[[0.1, 0.1, 0.205], [0.102, 0.13, 0.17], [0.104, 0.145, 0.08]], 0.0045, 10), Finish::Chrome);
    let dial = |x: f32| to_front(cylinder(0.018, 0.014, 28)).moved(Vec3::new(x, 0.1448, 0.285));
    b.part(machine, "dials", dial(-0.075).with(dial(0.075)), Finish::Chrome);
    b.part(machine, "gauge", to_front(cylinder(0.022, 0.006, 32)).moved(Vec3::new(0.0, 0.1448, 0.285)), Finish::WhitePlastic);
    let corners = [[-0.11, -0.13, 0.345], [-0.11, 0.12, 0.345], [0.11, 0.12, 0.345], [0.11, -0.13, 0.345]];
    let posts = corners.map(|[x, y, z]| rod([x, y, 0.325], [x, y, z], 0.003, 8));
    b.part(machine, "cup_rail", wire(&corners, 0.003, 8).with(all(posts)), Finish::Chrome);
}

fn blender(b: &mut Builder, blender: &Object, body: Finish) {
    b.part(
        blender,
        "base",
        loft(&[[0.16, 0.16, 0.03, 0.0], [0.16, 0.16, 0.03, 0.02], [0.115, 0.115, 0.04, 0.13], [0.105, 0.105, 0.04, 0.135]], 5),
        body,
    );
    b.part(blender, "dial", to_front(cylinder(0.022, 0.014, 28)).moved(Vec3::new(0.0, 0.072, 0.055)), Finish::Chrome);
    let jug = vessel(&[[0.046, 0.136], [0.048, 0.15], [0.062, 0.27], [0.066, 0.36]], 0.003, 40);
    b.part(blender, "jug", jug, Finish::DrinkingGlass);
    b.part(
        blender,
        "lid",
        turned(&[[0.0, 0.361], [0.066, 0.361], [0.068, 0.364], [0.066, 0.378], [0.03, 0.38], [0.028, 0.395], [0.0, 0.396]], 40),
        Finish::BlackPlastic,
    );
    let grip = wire(&[[0.06, 0.0, 0.34], [0.098, 0.0, 0.34], [0.1, 0.0, 0.25], [0.055, 0.0, 0.2]], 0.008, 10);
    b.part(blender, "grip", grip, Finish::DrinkingGlass);
}

fn scales(b: &mut Builder, scales: &Object) {
    b.part(scales, "plate", rounded_box(Vec3::new(0.155, 0.215, 0.014), 0.005, 3).moved(Vec3::new(0.0, 0.0, 0.0105)), Finish::GlossBlack);
    // Upright for someone who stands before it.
    let display = picture(0.064, 0.026).turned(Vec3::X, FRAC_PI_2).moved(Vec3::new(0.0, 0.081, 0.0178));
    b.part(scales, "display", display, Finish::ScreenOn(0));
    let feet = all([(-1.0, -1.0), (1.0, -1.0), (-1.0, 1.0), (1.0, 1.0)]
        .map(|(x, y): (f32, f32)| cylinder(0.009, 0.005, 14).moved(Vec3::new(0.06 * x, 0.09 * y, 0.0))));
    b.part(scales, "feet", feet, Finish::Rubber);
}

fn microwave(b: &mut Builder, oven: &Object, body: Finish) {
    let (w, d, h) = (0.46, 0.34, 0.265);
    b.part(oven, "body", rounded_box(Vec3::new(w, d, h), 0.006, 2).moved(Vec3::new(0.0, -0.012, 0.012 + 0.5 * h)), body);
    let y = 0.5 * d - 0.012;
    b.part(oven, "door", board([-0.5 * w, y + CONTACT, 0.014], [0.115, y + 0.02, 0.01 + h], 0.003), body);
    b.part(oven, "window", board([-0.5 * w + 0.03, y + 0.0195, 0.05], [0.075, y + 0.0208, h - 0.028], 0.0006), Finish::GlossBlack);
    b.part(oven, "panel", board([0.117, y + CONTACT, 0.014], [0.5 * w, y + 0.018, 0.01 + h], 0.003), Finish::BlackPlastic);
    b.part(oven, "display", picture(0.086, 0.03).moved(Vec3::new(0.173, y + 0.0183, 0.23)), Finish::ScreenOn(0));
    let buttons = all((0..12).map(|k| {
        let (x, z) = (0.145 + 0.028 * (k % 3) as f32, 0.19 - 0.027 * (k / 3) as f32);
        board([x - 0.010, y + 0.0175, z - 0.007], [x + 0.010, y + 0.0195, z + 0.007], 0.001)
    }));
    b.part(oven, "buttons", buttons, Finish::Aluminium);
    let x = 0.095;
    let grip = all([
        rod([x, y + 0.045, 0.06], [x, y + 0.045, 0.22], 0.006, 12),
        rod([x, y + 0.018, 0.08], [x, y + 0.044, 0.08], 0.004, 8),
        rod([x, y + 0.018, 0.2], [x, y + 0.044, 0.2], 0.004, 8),
    ]);
    b.part(oven, "grip", grip, Finish::Chrome);
    let feet = all([(-1.0, -1.0), (1.0, -1.0), (-1.0, 1.0), (1.0, 1.0)]
        .map(|(x, s): (f32, f32)| cylinder(0.013, 0.014, 14).moved(Vec3::new(0.19 * x, 0.13 * s - 0.012, 0.0))));
    b.part(oven, "feet", feet, Finish::Rubber);
}

fn stand_mixer(b: &mut Builder, mixer: &Object, body: Finish) {
    b.part(mixer, "base", rounded_box(Vec3::new(0.19, 0.34, 0.04), 0.019, 5).moved(Vec3::new(0.0, 0.0, 0.02)), body);
    let column = loft(&[[0.10, 0.12, 0.045, 0.035], [0.085, 0.10, 0.04, 0.10], [0.09, 0.11, 0.044, 0.25]], 6);
    b.part(mixer, "column", column.moved(Vec3::new(0.0, -0.1, 0.0)), body);
    let head = loft(
        &[
            [0.08, 0.08, 0.038, 0.0],
            [0.115, 0.115, 0.05, 0.03],
            [0.125, 0.12, 0.055, 0.2],
            [0.10, 0.10, 0.045, 0.31],
            [0.05, 0.05, 0.02, 0.335],
        ],
        7,
    );
    b.part(mixer, "head", to_front(head).moved(Vec3::new(0.0, -0.17, 0.285)), body);
    let bowl = vessel(&[[0.05, 0.041], [0.055, 0.046], [0.085, 0.075], [0.095, 0.12], [0.098, 0.165]], 0.0018, 44);
    b.part(mixer, "bowl", bowl.moved(Vec3::new(0.0, 0.07, 0.0)), Finish::Chrome);
    b.part(mixer, "shaft", cylinder(0.013, 0.12, 20).moved(Vec3::new(0.0, 0.07, 0.12)), Finish::Chrome);
    b.part(mixer, "lever", cylinder(0.012, 0.02, 20).turned(Vec3::Y, FRAC_PI_2).moved(Vec3::new(0.055, -0.1, 0.275)), Finish::Chrome);
}
