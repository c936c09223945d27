//! The bodies of a scene on a report page: all of them in every view, each where it stands.

use anyhow::Result;
use cloudtouch::geom::Point3;
use cloudtouch::{Body, Checked, PairAnswer, Report, Scene, SceneError};
use cloudtouch_page::{Asked, Body as Drawn, Fact, Shape, Standing, View};

use crate::answers::scene::{self, place};
use crate::inside;

/// Who is drawn, the largest first, or the one that keeps its place.
pub(super) struct Cast {
    names: Vec<String>,
    bodies: Vec<Drawn>,
}

impl Cast {
    /// All bodies of a scene, `first` before the others if there is one of that name; `about` tells what each was
    /// taken for.
    pub(super) fn of(scene: &Scene, first: &str, about: impl Fn(&str) -> String) -> Result<Self> {
        let size = |[low, high]: [Point3; 2]| (high - low).norm();
        let mut names: Vec<(&str, f64)> =
            scene.boxes().into_iter().map(|(name, corners)| (name, size(corners))).collect();
        names.sort_by(|(p, of_p), (q, of_q)| {
            (*q == first).cmp(&(*p == first)).then(of_q.total_cmp(of_p))
        });
        let drawn = |(name, _): &(&str, f64)| -> Result<Drawn> {
            let shape = match &**scene.body(name)? {
                Body::Cloud(cloud) => Shape::cloud(cloud.len(), |index| cloud.point(index)),
                Body::Mesh(mesh) => mesh.into(),
            };
            Ok(Drawn { name: (*name).to_owned(), about: about(name), shape })
        };
        let bodies = names.iter().map(drawn).collect::<Result<_>>()?;
        let names = names.into_iter().map(|(name, _)| name.to_owned()).collect();
        Ok(Self { names, bodies })
    }

    /// What the page draws.
    pub(super) fn into_bodies(self) -> Vec<Drawn> {
        self.bodies
    }

    /// A line for each body: what it was taken for, and where it is.
    pub(super) fn facts(&self, scene: &Scene) -> Vec<Fact> {
        let boxes = scene.boxes();
        let fact = |body: &Drawn| {
            let place = boxes.get(&*body.name).map(place);
            let parts = [Some(body.about.clone()).filter(|about| !about.is_empty()), place];
            let parts: Vec<String> = parts.into_iter().flatten().collect();
            Fact::new(&body.name, parts.join(", "))
        };
        self.bodies.iter().map(fact).collect()
    }

    /// All bodies, of which nothing is told.
    pub(super) fn overview(
        &self,
        scene: &Scene,
        name: impl Into<String>,
    ) -> Result<View<'static>, SceneError> {
        Ok(View::of_all(name, self.standing(scene)?))
    }

    /// A pair with its answer, and the others around it.
    pub(super) fn view<'a>(
        &self,
        scene: &Scene,
        name: impl Into<String>,
        (pair, report): (&PairAnswer, &'a Report),
    ) -> Result<View<'a>, SceneError> {
        let (of_pair, around): (Vec<Standing>, Vec<Standing>) =
            self.standing(scene)?.into_iter().partition(|standing| {
                let name = &self.names[standing.body];
                *name == pair.a || *name == pair.b
            });
        let of = |name: &str| of_pair.iter().copied().find(|of| self.names[of.body] == name);
        let asked = of(&pair.a).zip(of(&pair.b)).map(|(scene, object)| Asked {
            scene,
            object,
            report,
            placement: None,
        });
        Ok(View { name: name.into(), asked, around, more: Vec::new() })
    }

    fn standing(&self, scene: &Scene) -> Result<Vec<Standing>, SceneError> {
        let at = |(body, name): (usize, &String)| Ok(Standing { body, pose: scene.pose(name)? });
        self.names.iter().enumerate().map(at).collect()
    }
}

/// Its two bodies, as a view is called.
pub(super) fn names(pair: &PairAnswer) -> String {
    format!("{} / {}", pair.a, pair.b)
}

/// The answer to a pair, if there is one, with the points that are inside of a mesh.
pub(super) fn colored(pair: &PairAnswer, scene: &Scene) -> Option<Report> {
    inside::of_a_pair(pair.answer.as_ref().ok()?.clone(), pair, scene).ok()
}

/// What is to be said of bodies by themselves, and of pairs without an answer.
pub(super) fn doubts(checked: &Checked) -> Vec<Fact> {
    let warnings = scene::warnings(checked).map(|words| Fact::new("Warning", words));
    let without = checked.pairs.iter().filter_map(|pair| {
        let error = pair.answer.as_ref().err()?;
        Some(Fact::new(format!("No answer: {}", names(pair)), error.to_string()))
    });
    warnings.chain(without).collect()
}
