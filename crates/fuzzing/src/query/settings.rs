//! Settings of clouds and queries, in range and out of it.

use arbitrary::{Result, Unstructured};
use cloudtouch::bvh::{Split, Traversal, TreeSettings};
use cloudtouch::noise::{Discretization, SensorModel, Summed};
use cloudtouch::paper::{Kernel, MeshPoints, RadiusRule, Scaling};
use cloudtouch::{
    CloudSettings, FilterSettings, OutlierSettings, PaperCloudSettings, PaperNoise, PaperSettings,
    Pooling, QuerySettings, VeilSettings,
};

use super::numbers::{count, number, setting};

pub(super) fn query_settings(u: &mut Unstructured<'_>) -> Result<QuerySettings> {
    let usual = QuerySettings::default();
    Ok(QuerySettings {
        accept: setting(u, usual.accept, 0.5, 1.0)?,
        reject: setting(u, usual.reject, 0.0, 0.5)?,
        gamma: setting(u, usual.gamma, 0.0, 1000.0)?,
        penalty: setting(u, usual.penalty, 0.0, 1e6)?,
        mesh_penalty_factor: setting(u, usual.mesh_penalty_factor, 0.0, 100.0)?,
        ellipsoid_radius: setting(u, usual.ellipsoid_radius, 0.0, 10.0)?,
        relative_gap: setting(u, usual.relative_gap, 1e-9, 1.0)?,
        prior: setting(u, usual.prior, 0.0, 1.0)?,
        stop_above: setting(u, usual.stop_above, 0.0, 2.0)?,
        max_contacts: count(u, usual.max_contacts)?,
        max_mesh_parts: count(u, usual.max_mesh_parts)?,
        ..usual
    })
}

pub(super) fn paper_settings(u: &mut Unstructured<'_>) -> Result<PaperSettings> {
    let usual = PaperSettings::default();
    let traversals = [usual.traversal, Traversal::Certified, Traversal::GapAware, Traversal::Paper];
    Ok(PaperSettings {
        accept: setting(u, usual.accept, 0.5, 1.0)?,
        reject: setting(u, usual.reject, 0.0, 0.5)?,
        pooling: if u.arbitrary()? { Pooling::NoisyOr } else { Pooling::Max },
        kernel: kernel(u)?,
        scaling: if u.arbitrary()? { Scaling::LeafPair } else { Scaling::Scene },
        penalty: setting(u, usual.penalty, 0.0, 1e6)?,
        mesh_penalty_factor: setting(u, usual.mesh_penalty_factor, 0.0, 100.0)?,
        kappa: setting(u, usual.kappa, 0.0, 1.0)?,
        radius_rule: if u.arbitrary()? { RadiusRule::Chebyshev } else { RadiusRule::Gaussian },
        balanced: u.arbitrary()?,
        plane_first: u.arbitrary()?,
        distrust_noise: u.arbitrary()?,
        points_inside: u.arbitrary()?,
        mesh_points: if u.arbitrary()? {
            MeshPoints::AsDenseAsCloud
        } else {
            MeshPoints::FourPerTriangle
        },
        relative_gap: setting(u, usual.relative_gap, 1e-9, 1.0)?,
        traversal: *u.choose(&traversals)?,
        cull_probability: setting(u, usual.cull_probability, 0.0, 1.0)?,
        stop_above: setting(u, usual.stop_above, 0.0, 2.0)?,
        max_contacts: count(u, usual.max_contacts)?,
        max_mesh_parts: count(u, usual.max_mesh_parts)?,
        seed: u.arbitrary::<u16>()?.into(),
        ..usual
    })
}

fn kernel(u: &mut Unstructured<'_>) -> Result<Kernel> {
    Ok(match u.arbitrary()? {
        true => Kernel::Linear,
        false => Kernel::Gaussian { gamma: setting(u, 10.0, 0.0, 1000.0)? },
    })
}

pub(super) fn cloud_settings(u: &mut Unstructured<'_>) -> Result<CloudSettings> {
    let mut settings = CloudSettings::new(sensor(u)?);
    if u.arbitrary()? {
        // Only half of the inputs spend bytes on what rarely matters.
        return Ok(settings);
    }
    change_filter(u, &mut settings.filter)?;
    settings.posterior.disc_std = setting(u, settings.posterior.disc_std, 0.0, 2.0)?;
    settings.tree = tree(u)?;
    Ok(settings)
}

pub(super) fn paper_cloud_settings(u: &mut Unstructured<'_>) -> Result<PaperCloudSettings> {
    let mut settings = PaperCloudSettings::new(sensor(u)?);
    if u.arbitrary()? {
        return Ok(settings);
    }
    change_filter(u, &mut settings.filter)?;
    if u.arbitrary()? {
        settings.model.noise = PaperNoise::Convolution;
    }
    let usual = settings.model.discretization;
    settings.model.discretization = Discretization {
        summed: if u.arbitrary()? { Summed::Neighbors } else { Summed::AllPoints },
        is_capped: u.arbitrary()?,
        neighbors: count(u, usual.neighbors)?,
        width: setting(u, usual.width, 0.0, 10.0)?,
    };
    settings.model.tree = tree(u)?;
    Ok(settings)
}

fn change_filter(u: &mut Unstructured<'_>, filter: &mut FilterSettings) -> Result<()> {
    filter.min_range = Some(setting(u, filter.min_range.unwrap_or(0.1), 0.0, 1.0)?);
    filter.max_range = setting(u, filter.max_range, 0.0, 10.0)?;
    filter.drop_duplicates = u.arbitrary()?;
    if u.arbitrary()? {
        let max_angle = setting(u, VeilSettings::default().max_angle, 0.0, 1.6)?;
        filter.veil = Some(VeilSettings { max_angle });
    }
    if u.arbitrary()? {
        let usual = OutlierSettings::default();
        filter.outliers = Some(OutlierSettings {
            neighbors: count(u, usual.neighbors)?,
            deviations: setting(u, usual.deviations, -1.0, 5.0)?,
        });
    }
    if u.arbitrary()? {
        filter.collision_map = Some(setting(u, 0.05, 0.0, 1.0)?);
    }
    Ok(())
}

fn tree(u: &mut Unstructured<'_>) -> Result<TreeSettings> {
    let usual = TreeSettings::default();
    Ok(TreeSettings {
        max_leaf_points: count(u, usual.max_leaf_points)?,
        min_leaf_points: count(u, usual.min_leaf_points)?,
        max_variation: setting(u, usual.max_variation, 0.0, 0.34)?,
        sibling_overlap: setting(u, usual.sibling_overlap, 0.0, 0.5)?,
        split: if u.arbitrary()? { Split::SurfaceArea } else { Split::Median },
    })
}

fn sensor(u: &mut Unstructured<'_>) -> Result<SensorModel> {
    Ok(match u.arbitrary::<u8>()? % 9 {
        0 => SensorModel::PerPoint,
        1 => SensorModel::Exact,
        2 => SensorModel::Isotropic { std: number(u)?.abs() },
        3 => SensorModel::Axes { stds: [number(u)?.abs(), number(u)?.abs(), number(u)?] },
        4 => SensorModel::Stereo {
            baseline: setting(u, 0.09, 0.0, 1.0)?,
            focal_px: setting(u, 570.0, 0.0, 1000.0)?,
            disparity_std: setting(u, 0.2, 0.0, 5.0)?,
        },
        5 => SensorModel::Kinect,
        6 => SensorModel::Lidar {
            range_std: setting(u, 0.02, 0.0, 1.0)?,
            beam_rad: setting(u, 0.003, 0.0, 1.0)?,
        },
        7 => SensorModel::TimeOfFlight {
            std: setting(u, 0.001, 0.0, 1.0)?,
            per_metre: setting(u, 0.001, 0.0, 1.0)?,
        },
        _ => SensorModel::Grid { resolution: setting(u, 0.05, 0.0, 1.0)? },
    })
}
