use cloudtouch_evaluation::{methods::Ours, sweep::{Asked, OURS, Plan, ask}};
fn main() {
    let args: Vec<String> = std::env::args().collect();
    let draws = args[1].parse().unwrap();
    let poses = args[2].parse().unwrap();
    let stream: u64 = args[3].parse().unwrap();
    let mut plan = Plan::full(draws, poses);
    plan.stream = stream;
    if let Some(only) = args.get(4) {
        plan.families.retain(|f| only.contains(f.name));
    }
    let methods = [Asked::always(Ours::new(OURS).unwrap().gathering_everything())];
    println!("family,kind,pair,points,std,draw,pose,collides,distance,z,crossing,misclassified,zz,inside,e0,e03,e06,e1,e15,e25,e1r6,depthsp,spacing,count,micros");
    for family in plan.families.clone() {
    plan.families = vec![family];
    let answers = ask(&plan, &methods).unwrap();
    for (q, s) in answers.questions.iter().zip(answers.said(OURS).unwrap()) {
        let s = s.unwrap();
        let e = s.evidence.unwrap();
        print!("{},{:?},{:?},{},{},{},{},{},{},{},{},{}", q.family, q.kind, q.pair, q.condition.points, q.condition.std, q.draw, q.pose, u8::from(q.collides), q.signed_distance, e.deviations, e.crossing, e.misclassified.map_or(-1.0, |m| m));
        for f in e.features { print!(",{f}"); }
        println!(",{}", s.micros);
    }
    }
}
