//! The settings that are tried: the defaults, and one change at a time.

use cloudtouch::{
    CloudSettings, Mode, QuerySettings,
    bvh::{Traversal, TreeSettings},
    noise::SensorModel,
};

/// Tree and query settings with what is not as it is by default.
pub(super) struct Setting {
    /// The setting that was changed.
    pub(super) changed: &'static str,
    /// Its value.
    pub(super) value: String,
    pub(super) tree: TreeSettings,
    pub(super) query: QuerySettings,
}

impl Setting {
    /// What it is called in figures and lists.
    pub(super) fn name(&self) -> String {
        format!("{} {}", self.changed, self.value).trim_end().to_owned()
    }

    fn new(changed: &'static str, value: impl ToString) -> Self {
        Self::of(Mode::Calibrated, changed, value)
    }

    fn of(mode: Mode, changed: &'static str, value: impl ToString) -> Self {
        let tree = CloudSettings::new(SensorModel::Exact, mode).tree;
        Self { changed, value: value.to_string(), tree, query: QuerySettings::new(mode) }
    }

    fn tree(changed: &'static str, value: impl ToString, edit: impl Fn(&mut TreeSettings)) -> Self {
        let mut setting = Self::new(changed, value);
        edit(&mut setting.tree);
        setting
    }

    fn query(
        changed: &'static str,
        value: impl ToString,
        edit: impl Fn(&mut QuerySettings),
    ) -> Self {
        let mut setting = Self::new(changed, value);
        edit(&mut setting.query);
        setting
    }
}

/// The defaults first.
pub(super) fn all() -> Vec<Setting> {
    let mut all = vec![Setting::new("default", "")];
    all.extend([8, 20, 40, 80].map(|n| Setting::tree("n_max", n, |tree| tree.max_leaf_points = n)));
    all.extend(
        [("0.02", 0.02), ("0.05", 0.05), ("0.2", 0.2), ("off", 1.0 / 3.0)]
            .map(|(value, most)| Setting::tree("σ_max", value, |tree| tree.max_variation = most)),
    );
    all.extend(
        [1e-9, 1e-4, 1e-3, 1e-2]
            .map(|p| Setting::query("ε", format!("{p:.0e}"), |query| query.cull_probability = p)),
    );
    all.extend([1e-1, 1e-2, 1e-4].map(|gap| {
        Setting::query("tolerance", format!("{gap:.0e}"), |query| query.relative_gap = gap)
    }));
    all.extend([1.0, 3.0, 20.0, 40.0].map(|g| Setting::query("γ", g, |query| query.gamma = g)));
    all.extend([1.0, 10.0, 1000.0].map(|c| Setting::query("C", c, |query| query.penalty = c)));
    all.extend(
        [("gap-aware", Traversal::GapAware), ("paper", Traversal::Paper)].map(|(value, kind)| {
            Setting::query("traversal", value, |query| query.traversal = kind)
        }),
    );
    all.push(Setting::of(Mode::Paper, "mode", "paper"));
    let mut certified = Setting::of(Mode::Paper, "mode", "paper, certified traversal");
    certified.query.traversal = Traversal::Certified;
    all.push(certified);
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_setting_is_sound_has_a_name_of_its_own_and_is_no_default_but_the_first() {
        let all = all();
        for (i, setting) in all.iter().enumerate() {
            cloudtouch::Query::new(setting.query).unwrap();
            setting.tree.validate().unwrap();
            let default = Setting::new("default", "");
            let is_default = setting.tree == default.tree && setting.query == default.query;
            assert_eq!(is_default, i == 0, "{}", setting.name());
            assert!(all[..i].iter().all(|other| other.name() != setting.name()));
        }
    }
}
