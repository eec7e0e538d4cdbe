use gyrocal_hypothesis::{SearchOptions, search, select, FittedModel};
use gyrocal_plant::*;
use gyrocal_plant_truth::duffing::*;
fn record(scenario:&Scenario, plant:&LoadedPlant)->PlantRecord{
    let run=simulate(scenario);
    PlantRecord{time_s:run.time_s,inputs:run.inputs.concat(),outputs:run.outputs.concat(),regressors:vec![]}.prepared(plant.description(),"t").unwrap()
}
#[test]
fn explore(){
    let plant=LoadedPlant::read(std::path::Path::new("../../examples/duffing/plant.json")).unwrap();
    for (i,h) in [Hidden::Nothing,Hidden::Nothing,Hidden::CubicSpring(-0.3),Hidden::CubicSpring(-0.03),Hidden::UnevenSpring(0.1),Hidden::QuadraticDrag(-0.05),Hidden::Force(0.05),Hidden::BentSensor(0.02),Hidden::LateSensor(0.02),Hidden::StiffnessStep(0.1,0.4),Hidden::DriveByPlace(0.05)].into_iter().enumerate(){
        let mut s=Scenario::random(i as u64+1); s.hidden=h; if i==1 {s.noise=2.0}
        let rec=record(&s,&plant);
        let t=std::time::Instant::now();
        let fit=match FittedPlant::nominal(&plant,rec,&[]){Ok(f)=>f,Err(e)=>{println!("{h:?} FAIL {e}");continue}};
        let t1=t.elapsed();
        let v=fit.values().to_vec();
        let sel=select(plant.tables(),&[],|_|None);
        let rows=fit.rows();
        println!("{h:?}: truth k {:.3} c {:.3} g {:.3}; fit {:.3} {:.3} {:.3} cost {:.1} starts {:?}",s.stiffness,s.damping,s.gain,v[2]+4.0,v[3]+0.3,v[4]+1.0,fit.cost(),fit.starts());
        match search(fit,rows,&sel,&SearchOptions::default()){
            Ok(r)=>{ println!("   thr {:.2} noise {:?} {:.2?}/{:.2?}",r.threshold,r.fitted.noise_ratios(),t1,t.elapsed());
                for f in &r.findings{ println!("   {} {:?} z {:.1} p {:.1e} none {:?} alt {:?}",f.effect,f.parameters.iter().map(|p|(p.estimate,p.sigma)).collect::<Vec<_>>(),f.z,f.p_value,f.none_of_these,f.alternatives.iter().map(|a|(a.effect,a.log_likelihood_deficit)).collect::<Vec<_>>());}
                for u in &r.unmodelled{println!("   unmodelled {}",u.description());}
            }
            Err(e)=>println!("   search {e}"),
        }
    }
}
