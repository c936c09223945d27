//! Pairs of bodies that may touch.

use std::collections::BTreeMap;

use crate::error::SceneError;

use super::bodies::Scene;

impl Scene {
    /// Says that two bodies may touch, such as a link and the next: they are not asked about.
    ///
    /// # Errors
    /// When one of them is not in the scene, or they are one.
    pub fn allow(&mut self, a: &str, b: &str) -> Result<(), SceneError> {
        let pair = self.pair(a, b)?;
        self.allowed.insert(pair);
        Ok(())
    }

    /// Takes that back.
    ///
    /// # Errors
    /// When one of them is not in the scene, or they are one.
    pub fn forbid(&mut self, a: &str, b: &str) -> Result<(), SceneError> {
        let pair = self.pair(a, b)?;
        self.allowed.remove(&pair);
        Ok(())
    }

    /// Whether two bodies may touch, by what was said.
    ///
    /// # Errors
    /// When one of them is not in the scene, or they are one.
    pub fn is_allowed(&self, a: &str, b: &str) -> Result<bool, SceneError> {
        Ok(self.allowed.contains(&self.pair(a, b)?))
    }

    /// Bodies that may touch all others, in the order of their names; a body alone among them.
    pub(super) fn unchecked(&self) -> Vec<String> {
        let mut left: BTreeMap<&str, usize> =
            self.bodies.keys().map(|name| (name.as_str(), self.bodies.len() - 1)).collect();
        for name in self.allowed.iter().flatten() {
            left.entry(name).and_modify(|pairs| *pairs -= 1);
        }
        left.into_iter().filter(|(_, pairs)| *pairs == 0).map(|(name, _)| name.to_owned()).collect()
    }

    fn pair(&self, a: &str, b: &str) -> Result<[String; 2], SceneError> {
        self.placed(a)?;
        self.placed(b)?;
        if a == b {
            return Err(SceneError::OneBody { name: a.to_owned() });
        }
        let mut pair = [a, b].map(str::to_owned);
        pair.sort();
        Ok(pair)
    }
}
