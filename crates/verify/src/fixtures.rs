//! The law of fixtures: what each of them sends sums to the picture.

use super::card::Card;
use super::color::{DIM, may_be_cut};
use super::law::Law;
use super::read::readable;
use super::scan::Scan;
use enfilade_dataset::Dataset;
use enfilade_frame::Layer;

/// Largest error that rounding to a float16 below 2⁻¹⁴ adds to each of a fixture's two layers.
const SUBNORMAL: f64 = 1.0 / (1 << 25) as f64;

/// Checks the light of each of `count` fixtures in a frame, with one in memory at a time. Nothing is checked if the rendered layers were
/// not kept.
pub(super) fn check(dataset: &Dataset, [scene, camera]: [&str; 2], number: u32, count: u32, scan: &mut Scan<'_>) -> Card {
    let mut card = Card::default();
    let place = format!("{scene}/{camera}/frame.{number:04}");
    let listed = readable(&mut card, dataset.read_fixtures(scene)).map_or(0, |fixtures| fixtures.len());
    let wrong = if listed == count as usize { 0.0 } else { f64::INFINITY };
    card.observe(Law::LightFixtures, wrong, || format!("{place}: light of {count} fixtures, but metadata_fixtures.csv has {listed}"));
    let layers = [scan.layer(Layer::DiffuseReflectance), scan.rendered(Layer::Color)];
    let [Some(reflectance), Some(color)] = layers else { return card };
    let size = [scan.frame.height as usize, scan.frame.width as usize];
    let mut sum = vec![0.0; color.len()];
    for fixture in 1..=count {
        let Some((found, light)) = readable(&mut card, dataset.read_fixture_layers(scene, camera, number, fixture)) else { return card };
        if found != size {
            let problem = || format!("{place}: fixture {fixture} has {}x{} pixels", found[1], found[0]);
            card.observe(Law::LightFixtures, f64::INFINITY, problem);
            return card;
        }
        for (i, sum) in sum.iter_mut().enumerate() {
            *sum += reflectance.get(i) * light.diffuse_illumination.get(i) + light.residual.get(i);
        }
    }
    let is_cut = may_be_cut(scan, color);
    let rounding = 2.0 * SUBNORMAL * f64::from(count);
    let error = |i: usize| ((sum[i] - color.get(i)).abs() - rounding).max(0.0) / color.get(i).max(DIM);
    let errors = (0..color.len()).filter(|i| !is_cut(i / 3)).map(|i| (i / 3, error(i)));
    scan.worst(Law::LightFixtures, "the light of fixtures does not sum to color", errors);
    card
}

#[cfg(test)]
mod tests {
    use super::*;
    use enfilade_dataset::{FileRecord, write_json};
    use enfilade_scene::Quiet;
    use enfilade_testroom as testroom;

    /// The laws that fail if the layers of the lamp in the first frame have the values of the sky's.
    fn failures(changed: &[Layer]) -> Vec<Law> {
        let folder = tempfile::tempdir().unwrap();
        let dataset = testroom::dataset(folder.path());
        let path = |fixture, layer| dataset.layout().fixture_layer("room", "cam_00", 0, fixture, layer);
        for &layer in changed {
            std::fs::copy(path(1, layer), path(2, layer)).unwrap();
        }
        let mut record = dataset.frame_record("room", "cam_00", 0).unwrap().unwrap();
        let file = |name: &String| FileRecord::of(&dataset.layout().scene_dir("room").join(name)).unwrap();
        record.files.iter_mut().for_each(|(name, found)| *found = file(name));
        write_json(&dataset.layout().frame_record("room", "cam_00", 0), &record).unwrap();
        let report = crate::verify_scene(&dataset, "room", &Quiet).unwrap();
        report.failures().map(|law| law.law).filter(|law| !matches!(law, Law::Checksums)).collect()
    }

    #[test]
    fn light_that_does_not_sum_to_the_picture_is_found() {
        assert_eq!(failures(&[]), []);
        assert!(failures(&[Layer::DiffuseIllumination]).contains(&Law::LightFixtures));
        assert!(failures(&[Layer::Residual]).contains(&Law::LightFixtures));
    }

    #[test]
    fn a_table_that_is_lost_is_found_and_a_copy_has_all() {
        let folder = tempfile::tempdir().unwrap();
        let dataset = testroom::dataset(&folder.path().join("room"));
        let copy = folder.path().join("copy");
        dataset.repack(&copy, None, &Quiet).unwrap();
        let copy = Dataset::open(&copy).unwrap();
        let lights = copy.read_fixture_layers("room", "cam_00", 1, 2).unwrap();
        assert_eq!(lights, dataset.read_fixture_layers("room", "cam_00", 1, 2).unwrap());
        dataset.write_fixtures("room", &[]).unwrap();
        let report = crate::verify_scene(&dataset, "room", &Quiet).unwrap();
        assert_eq!(report.failures().map(|law| law.law).collect::<Vec<_>>(), [Law::LightFixtures]);
    }
}
