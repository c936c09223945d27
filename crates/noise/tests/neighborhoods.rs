//! The index against brute force, on clouds that break k-d trees.

use cloudtouch_geom::{Covariance, Point3, Vector3, seed};
use cloudtouch_noise::{
    Combination, Neighbor, Neighborhoods, NoiseError, NoiseModel, NoiseSettings, Scratch,
    SensorNoise, typical_spacing,
};
use proptest::prelude::*;

/// The reference: every other position once, [in order](in_order).
fn brute_force(
    points: &[Point3],
    place: &Point3,
    leave_out_place: bool,
    k: usize,
) -> Vec<Neighbor> {
    let all: Vec<Neighbor> = (0..points.len())
        .filter(|&i| points[i].coords.iter().all(|v| v.is_finite()))
        .filter(|&i| !(0..i).any(|j| points[j] == points[i]))
        .filter(|&i| !(leave_out_place && points[i] == *place))
        .map(|index| Neighbor { index, squared_distance: (points[index] - place).norm_squared() })
        .collect();
    in_order(points, place, all, k)
}

/// The first k of what is about a place, by distance, and of what is as near as the next, but for rounding, by x, y
/// and z of the way there.
fn in_order(points: &[Point3], place: &Point3, mut all: Vec<Neighbor>, k: usize) -> Vec<Neighbor> {
    all.sort_by(|a, b| a.squared_distance.total_cmp(&b.squared_distance));
    let way = |near: &Neighbor| {
        let steps = 1e4 / near.squared_distance.sqrt();
        let way = ((points[near.index] - place) * steps).map(|v| v.round() as i64);
        (<[i64; 3]>::from(way), near.index)
    };
    let is_tied = |near: &Neighbor, next: &Neighbor| {
        next.squared_distance <= near.squared_distance * (1.0 + 1e-7)
    };
    all.chunk_by_mut(is_tied).for_each(|tied| tied.sort_by_key(way));
    all.truncate(k);
    all
}

fn check_all(points: &[Point3], k: usize) {
    check(&Neighborhoods::new(points.to_vec()).expect("an index"), points, k);
}

fn check(index: &Neighborhoods, points: &[Point3], k: usize) {
    // Buffers that have seen another cloud, and each point in turn, near or far.
    let moved = points.iter().map(|p| p + Vector3::x()).collect();
    let other = Neighborhoods::new(moved).expect("an index");
    let mut scratch = Scratch::default();
    for (i, place) in points.iter().enumerate() {
        if place.coords.iter().all(|v| v.is_finite()) {
            let nearest = brute_force(points, place, true, k);
            assert_eq!(index.nearest(i, k), nearest, "point {i}");
            assert_eq!(index.nearest_with(i, k, &mut scratch), nearest, "point {i} by a block");
            if i % 7 == 0 {
                other.nearest_with(i, k, &mut scratch);
            }
            assert_eq!(index.nearest_to(place, k), brute_force(points, place, false, k));
        } else {
            assert!(index.nearest(i, k).is_empty());
            assert!(index.nearest_with(i, k, &mut scratch).is_empty());
        }
    }
}

#[test]
fn where_a_grid_is_and_how_it_is_numbered_decided_which_of_its_ties_came_first() {
    let grid: Vec<Point3> = (0..400_u32)
        .map(|i| 0.02 * Point3::new((i % 20).into(), (i / 20).into(), ((i % 20) / 3).into()))
        .collect();
    let shift = Vector3::new(10.37, -3.3, 400_000.7);
    let moved: Vec<Point3> = grid.iter().rev().map(|p| p + shift).collect();
    let [here, there] =
        [&grid, &moved].map(|points| Neighborhoods::new(points.clone()).expect("an index"));
    let mut scratch = Scratch::default();
    for i in 0..grid.len() {
        for k in [8, 16, 30] {
            let expected: Vec<usize> = here.nearest(i, k).iter().map(|near| near.index).collect();
            let own = grid.len() - 1 - i;
            for found in [there.nearest(own, k), there.nearest_with(own, k, &mut scratch).to_vec()]
            {
                let found: Vec<usize> =
                    found.iter().map(|near| grid.len() - 1 - near.index).collect();
                assert_eq!(found, expected, "{i} {k}");
            }
        }
    }
}

/// Integer coordinates: ties and duplicates everywhere, and exact distances.
fn lattice_points() -> impl Strategy<Value = Vec<Point3>> {
    let coordinate = prop_oneof![9 => (-3..4_i32).prop_map(f64::from), 1 => Just(f64::NAN)];
    prop::collection::vec(prop::array::uniform3(coordinate).prop_map(Point3::from), 0..80)
}

/// Once in some ten thousand neighbours two are as near but for a part in ten million.
#[test]
fn what_is_nearly_as_near_comes_by_its_direction() {
    let points = [[0.5983, -0.7713, 0.9361], [0.9594, -0.4552, 0.4470], [0.6, -0.1, 0.0]];
    let mut points = points.map(Point3::from).to_vec();
    // As far from the second as the first is, and a hair nearer.
    let way = points[0] - points[1];
    points[2] = points[1] - way * (1.0 - 2e-8);
    check_all(&points, 1);
}

proptest! {
    #[test]
    fn agrees_with_brute_force_where_everything_ties(points in lattice_points(), k in 0..20_usize) {
        check_all(&points, k);
    }

    #[test]
    fn agrees_with_brute_force_at_random(
        points in prop::collection::vec(
            prop::array::uniform3(-1.0..1.0_f64).prop_map(Point3::from), 0..200),
        k in 0..20_usize,
    ) {
        check_all(&points, k);
    }
}

proptest! {
    /// Several changes one after the other, each of a few points that go, come and move.
    #[test]
    fn a_changed_index_agrees_with_brute_force(
        points in prop::collection::vec(
            prop::array::uniform3(-1.0..1.0_f64).prop_map(Point3::from), 60..200),
        changes in prop::collection::vec((0..50_usize, 0..5_usize, any::<u64>()), 1..4),
        k in 1..20_usize,
    ) {
        let mut points = points;
        let mut index = Neighborhoods::new(points.clone()).expect("an index");
        for (at, count, stream) in changes {
            let place = |i: usize| {
                let draw = |k| 2.0 * seed::unit(seed::derive(stream, i as u64, k)) - 1.0;
                Point3::new(draw(0), draw(1), draw(2))
            };
            let mut before: Vec<Option<u32>> = (0..points.len() as u32).map(Some).collect();
            before.drain(at..at + count);
            points.drain(at..at + count);
            for i in 0..count {
                (points[i], before[i]) = (place(i), None);
                points.push(place(9 + i));
                before.push(None);
            }
            match index.changed(points.clone().into(), &before).expect("an index") {
                Some(changed) => index = changed,
                None => index = Neighborhoods::new(points.clone()).expect("an index"),
            }
            check(&index, &points, k);
        }
    }
}

/// A changed index says so where it would not be one over distinct positions, or a slow one.
#[test]
fn an_index_is_built_anew_where_that_is_better() {
    let points: Vec<Point3> =
        (0..100).map(|i| Point3::new(f64::from(i % 10), f64::from(i / 10), 0.0)).collect();
    let index = Neighborhoods::new(points.clone()).unwrap();
    let becomes = |place: Option<Point3>, kept: u32| {
        let kept = 0..kept;
        let mut now: Vec<Point3> = kept.clone().map(|i| points[i as usize]).collect();
        let mut before: Vec<Option<u32>> = kept.map(Some).collect();
        now.extend(place);
        before.extend(place.map(|_| None));
        index.changed(now.into(), &before).unwrap().is_some()
    };
    assert!(becomes(Some(Point3::new(0.5, 0.0, 0.0)), 100) && becomes(None, 80));
    assert!(!becomes(Some(points[50]), 100) && !becomes(None, 70));
    assert!(!becomes(Some(Point3::new(f64::NAN, 0.0, 0.0)), 100));
    // A position that went may come again.
    let (mut now, mut before) = (points.clone(), (0..100).map(Some).collect::<Vec<_>>());
    now.swap(0, 1);
    (before[0], before[1]) = (None, None);
    let swapped = index.changed(now.clone().into(), &before).unwrap().unwrap();
    check(&swapped, &now, 7);
    let twice = Neighborhoods::new(vec![points[0]; 30]).unwrap();
    assert!(twice.changed(vec![points[0]; 29].into(), &before[..29]).unwrap().is_none());
}

#[test]
fn twenty_thousand_points_of_a_grid() {
    let points: Vec<Point3> =
        (0..20_000).map(|i| Point3::new(f64::from(i % 200), f64::from(i / 200), 0.0)).collect();
    let index = Neighborhoods::new(points.clone()).unwrap();
    assert_eq!(index.distinct(), 20_000);
    for i in (0..points.len()).step_by(997) {
        assert_eq!(index.nearest(i, 21), brute_force_fast(&points, i, 21), "point {i}");
    }
    let typical = typical_spacing(&index, 1000);
    assert!((0.9..1.1).contains(&typical), "spacing {typical} of a unit grid");
}

/// The reference without its quadratic search for duplicates.
fn brute_force_fast(points: &[Point3], i: usize, k: usize) -> Vec<Neighbor> {
    let all: Vec<Neighbor> = (0..points.len())
        .filter(|&j| j != i)
        .map(|j| Neighbor { index: j, squared_distance: (points[j] - points[i]).norm_squared() })
        .collect();
    in_order(points, &points[i], all, k)
}

/// A dense patch beside a sparse one, walked through and jumped about: blocks that are too small, too
/// large, and left behind.
#[test]
fn blocks_find_what_single_searches_find() {
    let points: Vec<Point3> = (0..3000)
        .map(|i| {
            let draw = |k| seed::unit(seed::derive(11, i, k));
            let size = if i % 3 == 0 { 10.0 } else { 0.5 };
            Point3::new(size * draw(0), size * draw(1), 0.01 * draw(2))
        })
        .collect();
    let index = Neighborhoods::new(points.clone()).unwrap();
    let mut walk: Vec<usize> = (0..points.len()).collect();
    walk.sort_by(|&i, &j| points[i].x.total_cmp(&points[j].x));
    for k in [1, 8, 60, 240] {
        let mut scratch = Scratch::default();
        for &i in
            walk.iter().step_by(7).chain((0..points.len()).step_by(53).collect::<Vec<_>>().iter())
        {
            assert_eq!(index.nearest_with(i, k, &mut scratch), index.nearest(i, k), "point {i}");
        }
    }
}

/// A lattice, whose neighbours are tied, with places stored twice, or a dense patch in a sparse one.
fn tied_or_uneven(is_lattice: bool, seed: u64) -> Vec<Point3> {
    let place = |i: u64| {
        let draw = |k| seed::unit(seed::derive(seed, i, k));
        let size = if i.is_multiple_of(3) { 10.0 } else { 0.5 };
        match is_lattice {
            true => Point3::new((i % 23) as f64, (i / 23 % 19) as f64, 0.0),
            false => Point3::new(size * draw(0), size * draw(1), 0.01 * draw(2)),
        }
    };
    (0..600).map(place).collect()
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 60, ..ProptestConfig::default() })]

    /// Whatever group a block is made for, and however far its neighbours are said to reach.
    #[test]
    fn gathered_blocks_tell_what_single_searches_tell(
        is_lattice in any::<bool>(),
        seed in any::<u64>(),
        about in 0..600_usize,
        group in 1..30_usize,
        k in 1..80_usize,
        reach in prop::option::of(0.0..8.0_f64),
    ) {
        let points = tied_or_uneven(is_lattice, seed);
        let index = Neighborhoods::new(points.clone()).unwrap();
        let sensor = SensorNoise::uniform(Covariance::isotropic(1e-6), points.len());
        let model = NoiseModel::new(NoiseSettings {
            combination: Combination::SurfacePosterior,
            ..NoiseSettings::default()
        }).unwrap();
        let mut members: Vec<usize> =
            index.nearest(about, group).iter().map(|near| near.index).collect();
        members.push((about + 300) % 600);
        let mut scratch = Scratch::default();
        for members in [&members[..group.min(members.len() - 1)], &members] {
            index.gather(members.iter().copied(), k, &mut scratch);
            for &i in members {
                prop_assert_eq!(index.nearest_with(i, k, &mut scratch), index.nearest(i, k));
            }
            model.gather(members.iter().copied(), &index, reach, &mut scratch);
            for &i in members {
                let refine = |s: &mut Scratch| model.refine(i, &index, &sensor, 1e3, s);
                prop_assert_eq!(refine(&mut scratch), refine(&mut Scratch::default()));
                prop_assert_eq!(scratch.neighbors(), index.nearest(i, 60));
            }
        }
    }
}

#[test]
fn a_heap_of_equal_points_is_one_position() {
    let mut points = vec![Point3::new(1.0, 2.0, 3.0); 500];
    let alone = Neighborhoods::new(points.clone()).unwrap();
    assert_eq!(alone.distinct(), 1);
    assert!(alone.nearest(250, 10).is_empty());
    assert_eq!(alone.nearest_to(&Point3::origin(), 10).len(), 1);

    points.extend((0..40).map(|i| Point3::new(f64::from(i), 0.0, -0.0)));
    points.push(Point3::new(0.0, -0.0, 0.0));
    check_all(&points, 12);
}

#[test]
fn nothing_and_one_point_have_no_neighbours() {
    let empty = Neighborhoods::new(Vec::new()).unwrap();
    assert!(empty.nearest_to(&Point3::origin(), 5).is_empty());
    assert_eq!(typical_spacing(&empty, 10), 0.0);
    let one = Neighborhoods::new(vec![Point3::origin()]).unwrap();
    assert!(one.nearest(0, 5).is_empty());
    assert!(one.nearest_to(&Point3::new(f64::NAN, 0.0, 0.0), 5).is_empty());
    assert_eq!(typical_spacing(&one, 10), 0.0);
}

#[test]
fn the_index_can_be_shared_between_threads() {
    fn shared<T: Send + Sync>() {}
    shared::<Neighborhoods>();
}

#[test]
fn coordinates_out_of_range_are_refused() {
    let points = vec![Point3::origin(), Point3::new(0.0, 1e200, 0.0)];
    assert!(matches!(
        Neighborhoods::new(points),
        Err(NoiseError::CoordinateRange { index: 1, .. })
    ));
}
